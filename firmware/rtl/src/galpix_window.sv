// Items of a map in raster order become windows of 3 x 3 around each of them.
//
//   above_left  above  above_right        Places outside the map hold anything; `left` ... `below` of `has` tell
//   beside_left centre beside_right       which neighbours there are.
//   below_left  below  below_right
//
// The items of a map may come with gaps; those of the next one only after `done`. A window comes `columns` + 1 items
// and two clocks after its centre; the last ones need no further items. Two rows of memory.
module galpix_window #(
    parameter int BITS = 8,
    parameter int COLUMN = 7,                  // bits of a column
    parameter int ROW = 4
) (
    input  logic              clk,
    input  logic              reset,
    input  logic              enable,
    input  logic [COLUMN:0]   columns,
    input  logic [ROW:0]      rows,
    input  logic              valid,
    input  logic [BITS-1:0]   item,
    output logic              window,          // a window is here
    output logic [COLUMN-1:0] column,          // of its centre
    output logic [ROW-1:0]    row,
    output logic [3:0]        has,             // left, right, above, below
    output logic [BITS-1:0]   above_left, above, above_right,
    output logic [BITS-1:0]   beside_left, centre, beside_right,
    output logic [BITS-1:0]   below_left, below, below_right,
    output logic              done,            // with the last window of the map
    output logic              next,            // a window is here a clock later
    output logic [ROW+COLUMN-1:0] next_at      // row and column of its centre
);
  // What comes in, and the two rows above it. After the last item `columns` + 1 ticks drain the windows.
  logic [COLUMN-1:0] at, at_1;
  logic [ROW-1:0] line;
  logic draining, tick, tick_1;
  logic [BITS-1:0] item_1, above_1, above_2;
  wire last_column = {1'b0, at} + 1'b1 == columns;
  assign tick = enable && (valid || draining);

  // Three columns of windows, and how many items there were until the first centre.
  logic [COLUMN+1:0] warmed;
  logic [COLUMN-1:0] next_column;
  logic [ROW-1:0] next_row;
  wire warm = warmed == (COLUMN + 2)'(columns) + 1'b1;
  wire next_last_column = {1'b0, next_column} + 1'b1 == columns;
  wire next_last_row = {1'b0, next_row} + 1'b1 == rows;
  assign next = enable && tick_1 && warm;
  assign next_at = {next_row, next_column};

  // In a map of one column the rows above are the items before, which the memory would give too late.
  wire one_wide = columns == 1;
  wire [BITS-1:0] new_above = one_wide ? beside_right : above_2;
  wire [BITS-1:0] new_beside = one_wide ? below_right : above_1;

  galpix_ram #(.BITS(BITS), .ADDRESS(COLUMN)) first (
      .clk, .write(enable && tick_1), .write_at(at_1), .data(item_1), .read(tick), .read_at(at), .q(above_1)
  );
  galpix_ram #(.BITS(BITS), .ADDRESS(COLUMN)) second (
      .clk, .write(enable && tick_1), .write_at(at_1), .data(new_beside), .read(tick), .read_at(at), .q(above_2)
  );

  always_ff @(posedge clk)
    if (reset) begin
      {at, line, draining, tick_1, warmed, next_column, next_row, window, done} <= '0;
    end else if (enable) begin
      tick_1 <= tick;
      window <= tick_1 && warm;
      done <= 1'b0;
      if (tick) begin
        item_1 <= item;
        at_1 <= at;
        at <= last_column ? '0 : at + 1'b1;
        if (last_column) line <= line + 1'b1;
        if (last_column && {1'b0, line} + 1'b1 == rows) draining <= 1'b1;
      end
      if (tick_1) begin
        {above_left, above, above_right} <= {above, above_right, new_above};
        {beside_left, centre, beside_right} <= {centre, beside_right, new_beside};
        {below_left, below, below_right} <= {below, below_right, item_1};
        if (!warm) warmed <= warmed + 1'b1;
        else begin
          column <= next_column;
          row <= next_row;
          has <= {next_column != 0, !next_last_column, next_row != 0, !next_last_row};
          next_column <= next_last_column ? '0 : next_column + 1'b1;
          if (next_last_column) next_row <= next_row + 1'b1;
          if (next_last_column && next_last_row) begin
            done <= 1'b1;
            {at, line, draining, tick_1, warmed, next_column, next_row} <= '0;
          end
        end
      end
    end
endmodule
