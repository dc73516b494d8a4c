// What is left open after the rounds of bullets takes what its fill mode says (specification, section 10). Cells come
// in raster order, one a clock; with EXTEND each comes out two rows and six clocks later, else six clocks later.
//
// EXTEND looks for the nearest cell on both sides of a hole. The right one is found when the row is read backwards,
// while the next row comes in, and used while the one after that does. Rows that are written one way and read the
// other need no second copy: what is read at a place is replaced there, and every row turns the direction of the
// places.
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

  // Clock 0: `tick` reads the memories. Clock 1: their words are registered. Clock 2: the cell, `item`, and the
  // nearest ones to its left and right, each with a bit that says whether there is one.
  logic tick, there, there_1, there_2, last, last_1, last_2;
  logic [ITEM-1:0] item;
  logic [RECORD:0] left, right;
  logic [RECORD-1:0] front_2;
  always_ff @(posedge clk)
    if (reset) {there_1, there_2, last_1, last_2} <= '0;
    else if (enable) begin
      {there_1, there_2} <= {there, there_1};
      {last_1, last_2} <= {there && last, last_1};
      front_2 <= front;
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
    logic [COLUMN-1:0] turned, turned_1, turned_2;
    logic [COLUMN:0] forward, forward_1;
    logic tick_1, tick_2, first_1, first_2;
    logic [ITEM-1:0] incoming, incoming_2, incoming_before, backward, backward_2, two_rows_on, two_rows_on_2;
    logic [RECORD:0] to_right, to_left, nearest_right, nearest_right_2, right_before;
    assign turned = line[0] ? COLUMN'(columns - 1'b1 - {1'b0, column}) : column;
    assign forward = {line[0], column};
    always_ff @(posedge clk)
      if (reset) {tick_1, tick_2} <= '0;
      else if (enable) begin
        {tick_1, tick_2} <= {tick, tick_1};
        if (tick) begin
          turned_1 <= turned;
          forward_1 <= forward;
          first_1 <= column == 0;
          incoming <= {state, record};
        end
        if (tick_1) begin
          turned_2 <= turned_1;
          first_2 <= first_1;
          backward_2 <= backward;
          two_rows_on_2 <= two_rows_on;
          nearest_right_2 <= nearest_right;
          {incoming_2, incoming_before} <= {incoming, incoming_2};
        end
      end

    // Where a row turns, what was replaced last is wanted next: the memories might not have it yet.
    wire [ITEM-1:0] last_back = first_2 ? incoming_before : backward_2;
    wire [RECORD:0] right_of_this = first_2 ? '0 : to_right;
    wire replace = enable && tick_1;
    galpix_ram #(.BITS(ITEM), .ADDRESS(COLUMN + 1)) rows_on (
        .clk, .write(replace), .write_at(forward_1), .data(incoming), .read(tick), .read_at(forward), .q(two_rows_on)
    );
    galpix_ram #(.BITS(ITEM), .ADDRESS(COLUMN)) row_back (
        .clk, .write(replace), .write_at(turned_1), .data(incoming), .read(tick), .read_at(turned), .q(backward)
    );
    galpix_ram #(.BITS(RECORD + 1), .ADDRESS(COLUMN)) rights (
        .clk, .write(enable && tick_2), .write_at(turned_2), .data(right_of_this), .read(tick), .read_at(turned),
        .q(nearest_right)
    );
    assign left = first_2 ? '0 : to_left;
    assign right = first_2 ? right_before : nearest_right_2;
    assign item = two_rows_on_2;
    always_ff @(posedge clk)
      if (enable && tick_2) begin
        right_before <= right_of_this;
        to_right <= held(last_back[RECORD +: 2]) ? {1'b1, last_back[RECORD-1:0]} : right_of_this;
        to_left <= held(item[RECORD +: 2]) ? {1'b1, item[RECORD-1:0]} : left;
      end
  end else begin : plain
    assign tick = enable && valid;
    assign there = tick;
    assign ask_row = line[ROW-1:0];
    assign {left, right} = '0;
    logic [ITEM-1:0] item_1;
    always_ff @(posedge clk)
      if (enable) {item_1, item} <= {state, record, item_1};
  end

  // Clock 3: everything in registers. Clock 4: which side is farther.
  wire [DEPTH-1:0] left_depth = galpixel::DEPTH_BITS > 0 ? left_3[galpixel::DEPTH_LSB +: DEPTH] : '0;
  wire [DEPTH-1:0] right_depth = galpixel::DEPTH_BITS > 0 ? right_3[galpixel::DEPTH_LSB +: DEPTH] : '0;
  logic [ITEM-1:0] item_3, item_4;
  logic [RECORD-1:0] front_3, front_4, side_4;
  logic [RECORD:0] left_3, right_3;
  logic there_3, there_4, last_3, last_4, side_is_4;
  wire take_right = !left_3[RECORD] || (right_3[RECORD] && right_depth > left_depth);
  always_ff @(posedge clk)
    if (reset) {there_3, there_4, last_3, last_4} <= '0;
    else if (enable) begin
      {there_3, there_4, last_3, last_4} <= {there_2, there_3, last_2, last_3};
      {item_3, item_4, front_3, front_4} <= {item, item_3, front_2, front_3};
      {left_3, right_3} <= {left, right};
      side_4 <= take_right ? right_3[RECORD-1:0] : left_3[RECORD-1:0];
      side_is_4 <= left_3[RECORD] || right_3[RECORD];
    end

  // Clock 5: what the cell becomes.
  wire known = front_4[galpixel::CLASS_LSB +: 2] != 2'd3;
  wire hole = item_4[RECORD +: 2] == HOLE;
  wire copies = GALDEBRIS && fill_mode >= 3'd4 && known;
  wire colours = fill_mode != 3'd0;
  wire debris = fill_mode >= 3'd2 && known;
  wire [RECORD-1:0] copied = EXTEND && fill_mode == 3'd5 && side_is_4 ? side_4 : front_4;
  wire [RECORD-1:0] coloured = (colours ? front_4 & COLOURS : '0) | (debris ? FARTHEST : '0);
  wire [1:0] class_of_hole = copies ? 2'd1 : !debris ? 2'd3 : fill_mode == 3'd2 ? 2'd2 : 2'd1;
  wire [RECORD-1:0] of_hole = ((copies ? copied : coloured) & ~CLASS) | (RECORD'(class_of_hole) << galpixel::CLASS_LSB);
  always_ff @(posedge clk)
    if (reset) {out_valid, done} <= '0;
    else if (enable) begin
      out_valid <= there_4;
      done <= last_4;
      out_record <= hole ? of_hole : item_4[RECORD-1:0];
      filled <= !hole ? 2'd0 : copies ? 2'd2 : debris ? 2'd1 : 2'd3;
    end
endmodule
