// What is left open after the rounds of bullets takes what its fill mode says (specification, section 10). Cells come in
// raster order, one a clock; with EXTEND each comes out two rows and five clocks later, else five clocks later.
//
// EXTEND looks for the nearest cell on both sides of a hole. The right one is found when the row is read backwards,
// while the next row comes in, and used while the one after that does. Rows that are written one way and read the other
// need no second copy: what is read at a place is replaced there, and every row turns the direction of the places.
module galpix_holes #(
    parameter int COLUMN = 7,
    parameter int ROW = 4,
    parameter bit EXTEND = 1,
    parameter bit GALDEBRIS = 1                // `front` is the whole galpixel, not class and colour alone
) (
    input  logic                        clk,
    input  logic                        reset,
    input  logic                        enable,
    input  logic [COLUMN:0]             columns,
    input  logic [ROW:0]                rows,
    input  logic [2:0]                  fill_mode,   // 0 none, 1 hold, 2 debris, 3 bullet, 4 galdebris, 5 extend
    input  logic                        valid,
    input  logic [1:0]                  state,
    input  logic [galpixel::RECORD-1:0] record,
    output logic                        ask,         // for the cell of the front map ...
    output logic [ROW-1:0]              ask_row,
    output logic [COLUMN-1:0]           ask_column,
    input  logic [galpixel::RECORD-1:0] front,      // ... which is here an enabled clock later
    output logic                        out_valid,
    output logic [galpixel::RECORD-1:0] out_record,
    output logic [1:0]                  filled,      // with it: 0 nothing, 1 debris, 2 galdebris, 3 empty
    output logic                        done         // with the last cell
);
  localparam int RECORD = galpixel::RECORD;
  localparam int ITEM = RECORD + 2;
  localparam int DEPTH = galpixel::DEPTH_BITS > 0 ? galpixel::DEPTH_BITS : 1;
  localparam logic [1:0] HOLE = 2'd0, FRESH = 2'd3;
  localparam logic [RECORD-1:0] CLASS = RECORD'(2'd3) << galpixel::CLASS_LSB;
  localparam logic [RECORD-1:0] COLOURS = RECORD'({galpixel::COLOUR_BITS{1'b1}}) << galpixel::COLOUR_LSB;
  localparam logic [RECORD-1:0] FARTHEST =
      galpixel::DEPTH_BITS > 0 ? RECORD'({DEPTH{1'b1}}) << galpixel::DEPTH_LSB : '0;

  function automatic logic held(input logic [1:0] state_of);
    held = state_of != HOLE && state_of != FRESH;
  endfunction

  // Which cell is decided: all of what follows is a clock after `tick`.
  logic tick, there, there_1, last, last_1;
  logic [ITEM-1:0] item_1;
  logic [RECORD:0] left, right;                // whether there is one, and the galpixel
  always_ff @(posedge clk)
    if (reset) {there_1, last_1} <= '0;
    else if (enable) begin
      there_1 <= there;
      last_1 <= there && last;
    end
  assign ask = enable && there;

  logic [COLUMN-1:0] column;
  logic [ROW+1:0] line;
  wire last_column = {1'b0, column} + 1'b1 == columns;
  wire [ROW+1:0] last_line = (ROW + 2)'(rows) - 1'b1 + (EXTEND ? (ROW + 2)'(2) : '0);
  assign last = last_column && line == last_line;
  assign ask_column = column;
  always_ff @(posedge clk)
    if (reset) {column, line} <= '0;
    else if (enable && tick) begin
      column <= last_column ? '0 : column + 1'b1;
      if (last_column) line <= last ? '0 : line + 1'b1;
    end

  if (EXTEND) begin : extend
    logic draining, two_on;
    logic [ROW-1:0] two_above;
    assign tick = enable && (valid || draining);
    assign there = tick && two_on;
    assign ask_row = two_above;
    always_ff @(posedge clk)
      if (reset) {draining, two_on, two_above} <= '0;
      else if (enable && tick && last_column) begin
        draining <= !last && line + 1'b1 >= (ROW + 2)'(rows);
        two_on <= !last && line != 0;
        two_above <= last || !two_on ? '0 : two_above + 1'b1;
      end

    // The places of this row.
    logic [COLUMN-1:0] turned, turned_1;
    logic [COLUMN:0] forward, forward_1;
    logic tick_1, first_1;
    logic [ITEM-1:0] incoming, backward, two_rows_on;
    assign turned = line[0] ? COLUMN'(columns - 1'b1 - {1'b0, column}) : column;
    assign forward = {line[0], column};
    always_ff @(posedge clk)
      if (reset) tick_1 <= 1'b0;
      else if (enable) begin
        tick_1 <= tick;
        if (tick) begin
          turned_1 <= turned;
          forward_1 <= forward;
          first_1 <= column == 0;
          incoming <= {state, record};
        end
      end

    // Where a row turns, what was replaced last is wanted next: the memories might not have it yet.
    logic [ITEM-1:0] incoming_before;
    logic [RECORD:0] to_right, to_left, nearest_right, right_before;
    wire [ITEM-1:0] last_back = first_1 ? incoming_before : backward;
    wire [RECORD:0] right_of_this = first_1 ? '0 : to_right;
    wire replace = enable && tick_1;
    galpix_ram #(.BITS(ITEM), .ADDRESS(COLUMN + 1)) rows_on (
        .clk, .write(replace), .write_at(forward_1), .data(incoming), .read(tick), .read_at(forward), .q(two_rows_on)
    );
    galpix_ram #(.BITS(ITEM), .ADDRESS(COLUMN)) row_back (
        .clk, .write(replace), .write_at(turned_1), .data(incoming), .read(tick), .read_at(turned), .q(backward)
    );
    galpix_ram #(.BITS(RECORD + 1), .ADDRESS(COLUMN)) rights (
        .clk, .write(replace), .write_at(turned_1), .data(right_of_this), .read(tick), .read_at(turned),
        .q(nearest_right)
    );
    assign left = first_1 ? '0 : to_left;
    assign right = first_1 ? right_before : nearest_right;
    assign item_1 = two_rows_on;
    always_ff @(posedge clk)
      if (enable && tick_1) begin
        incoming_before <= incoming;
        right_before <= right_of_this;
        to_right <= held(last_back[RECORD +: 2]) ? {1'b1, last_back[RECORD-1:0]} : right_of_this;
        to_left <= held(two_rows_on[RECORD +: 2]) ? {1'b1, two_rows_on[RECORD-1:0]} : left;
      end
  end else begin : plain
    assign tick = enable && valid;
    assign there = tick;
    assign ask_row = line[ROW-1:0];
    assign {left, right} = '0;
    always_ff @(posedge clk)
      if (enable && tick) item_1 <= {state, record};
  end

  // Clock 2: everything in registers. Clock 3: which side is farther.
  wire [DEPTH-1:0] left_depth = galpixel::DEPTH_BITS > 0 ? left_2[galpixel::DEPTH_LSB +: DEPTH] : '0;
  wire [DEPTH-1:0] right_depth = galpixel::DEPTH_BITS > 0 ? right_2[galpixel::DEPTH_LSB +: DEPTH] : '0;
  logic [ITEM-1:0] item_2, item_3;
  logic [RECORD-1:0] front_2, front_3, side_3;
  logic [RECORD:0] left_2, right_2;
  logic there_2, there_3, last_2, last_3, side_is_3;
  wire take_right = !left_2[RECORD] || (right_2[RECORD] && right_depth > left_depth);
  always_ff @(posedge clk)
    if (reset) {there_2, there_3, last_2, last_3} <= '0;
    else if (enable) begin
      {there_2, there_3, last_2, last_3} <= {there_1, there_2, last_1, last_2};
      {item_2, item_3, front_2, front_3} <= {item_1, item_2, front, front_2};
      {left_2, right_2} <= {left, right};
      side_3 <= take_right ? right_2[RECORD-1:0] : left_2[RECORD-1:0];
      side_is_3 <= left_2[RECORD] || right_2[RECORD];
    end

  // Clock 4: what the cell becomes.
  wire known = front_3[galpixel::CLASS_LSB +: 2] != 2'd3;
  wire hole = item_3[RECORD +: 2] == HOLE;
  wire copies = GALDEBRIS && fill_mode >= 3'd4 && known;
  wire colours = fill_mode != 3'd0;
  wire debris = fill_mode >= 3'd2 && known;
  wire [RECORD-1:0] copied = EXTEND && fill_mode == 3'd5 && side_is_3 ? side_3 : front_3;
  wire [RECORD-1:0] coloured = (colours ? front_3 & COLOURS : '0) | (debris ? FARTHEST : '0);
  wire [1:0] class_of_hole = copies ? 2'd1 : !debris ? 2'd3 : fill_mode == 3'd2 ? 2'd2 : 2'd1;
  wire [RECORD-1:0] of_hole = ((copies ? copied : coloured) & ~CLASS) | (RECORD'(class_of_hole) << galpixel::CLASS_LSB);
  always_ff @(posedge clk)
    if (reset) {out_valid, done} <= '0;
    else if (enable) begin
      out_valid <= there_3;
      done <= last_3;
      out_record <= hole ? of_hole : item_3[RECORD-1:0];
      filled <= !hole ? 2'd0 : copies ? 2'd2 : debris ? 2'd1 : 2'd3;
    end
endmodule
