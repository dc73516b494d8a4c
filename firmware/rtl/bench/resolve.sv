// The arrivals of one `resolve` case, in their order, in `galpix_band`: which compares the numbers of sources too.
`timescale 1ns / 1ps
module resolve;
  parameter int COLUMN = 7, ROW = 4;
  localparam int RECORD = galpixel::RECORD, WORDS = galpixel::WORDS, MOST = 1 << (COLUMN + ROW);

  logic clk = 0, reset = 1, ready, source = 0, arrives = 0, collided, valid;
  logic [31:0] columns, rows, arrivals;
  logic [31:0] sources[0:MOST-1], cells_of[0:MOST-1], words[0:MOST*WORDS-1], map[0:MOST*WORDS-1], winners[0:MOST-1];
  logic [31:0] counts[0:9];
  logic [ROW-1:0] to_row = '0;
  logic [COLUMN-1:0] to_column = '0;
  logic [15:0] number = '0, winner;
  logic [RECORD-1:0] record = '0, cell_record, want;
  logic [1:0] state;
  logic [ROW:0] row;
  string folder;
  int cells, n, k, at, right, wrong, lost, collisions;
  always #5 clk = !clk;

  galpix_band #(.COLUMN(COLUMN), .ROW(ROW), .BAND(ROW), .SOURCE(16), .ORDERED(0)) dut (
      .clk, .reset, .enable(1'b1), .ready, .columns(columns[COLUMN:0]), .rows(rows[ROW:0]), .reach(rows[ROW:0]), .source,
      .arrives, .to_row, .to_column, .on_edge(1'b0), .number, .record, .collided, .valid, .state, .cell_record, .winner,
      .row
  );
  always @(posedge clk) if (collided) collisions++;

  always @(negedge clk)
    if (valid && !reset) begin
      for (k = 0; k < WORDS; k++) want[32*(WORDS-1-k) +: 32] = map[k*cells + at];
      if (state == 0 ? winners[at] === 32'hffffffff && want[galpixel::CLASS_LSB +: 2] === 2'd3
                     : winners[at] === 32'(winner) && want === cell_record) right++;
      else begin
        wrong++;
        if (wrong < 5) $display("cell %0d: state %0d, winner %0d, %h, not %0d, %h", at, state, winner, cell_record, winners[at], want);
      end
      at++;
    end

  initial begin
    if (!($value$plusargs("folder=%s", folder) && $value$plusargs("columns=%d", columns)
          && $value$plusargs("rows=%d", rows) && $value$plusargs("arrivals=%d", arrivals))) $fatal(1, "an argument is missing");
    cells = columns * rows;
    {at, right, wrong, lost, collisions} = '0;
    if (arrivals > 0) begin
      $readmemh({folder, "/source.hex"}, sources, 0, arrivals - 1);
      $readmemh({folder, "/cell.hex"}, cells_of, 0, arrivals - 1);
      $readmemh({folder, "/arrivals.hex"}, words, 0, WORDS * arrivals - 1);
    end
    $readmemh({folder, "/map.hex"}, map, 0, WORDS * cells - 1);
    $readmemh({folder, "/winners.hex"}, winners, 0, cells - 1);
    $readmemh({folder, "/counts.hex"}, counts, 0, 9);
    repeat (4) @(negedge clk);
    reset = 0;
    while (!ready) @(negedge clk);
    // One place of the front map has no arrival for each cell that is empty there: they come last.
    for (n = 0; n < cells; n++) begin
      source = 1;
      arrives = 0;
      if (n < arrivals) begin
        arrives = cells_of[n] != 32'hffffffff;
        lost += 32'(!arrives);
        to_row = ROW'(cells_of[n] / columns);
        to_column = COLUMN'(cells_of[n] % columns);
        number = sources[n][15:0];
        for (k = 0; k < WORDS; k++) record[32*(WORDS-1-k) +: 32] = words[n*WORDS + k];
      end
      @(negedge clk);
    end
    {source, arrives} = '0;
    repeat (cells + 16) @(negedge clk);
    if (at != cells || arrivals != counts[0] || lost != counts[1] || collisions != counts[2]) begin
      wrong++;
      $display("cells %0d, moved %0d, lost %0d, collided %0d, not %0d, %0d, %0d, %0d", at, arrivals, lost, collisions, cells,
               counts[0], counts[1], counts[2]);
    end else right += 4;
    $display("RESULT %0d %0d", right, wrong);
    $finish;
  end
endmodule
