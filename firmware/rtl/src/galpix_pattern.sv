// A camera that sends a test pattern: galpixels of bars, and of a box in front that moves by one and a half cells to
// the right and half a cell down in each frame. One a clock in raster order while `next` holds.
module galpix_pattern #(
    parameter int COLUMN = 6,
    parameter int ROW = 6
) (
    input  logic                        clk,
    input  logic                        reset,
    input  logic [COLUMN:0]             columns,
    input  logic [ROW:0]                rows,
    input  logic                        next,
    output logic [ROW+COLUMN-1:0]       at,          // row and column
    output logic [galpixel::RECORD-1:0] galpixel_there,
    output logic                        last
);
  localparam int RECORD = galpixel::RECORD;
  localparam int COLOUR = galpixel::COLOUR_BITS;
  localparam int DEPTH = galpixel::DEPTH_BITS > 0 ? galpixel::DEPTH_BITS : 1;
  localparam logic [RECORD-1:0] NEAR = galpixel::DEPTH_BITS > 2 ? RECORD'(1) << (galpixel::DEPTH_LSB + DEPTH - 2) : '0;
  localparam logic [RECORD-1:0] FAR =
      galpixel::DEPTH_BITS > 0 ? RECORD'({DEPTH{1'b1}}) << galpixel::DEPTH_LSB : '0;
  localparam logic [RECORD-1:0] MOVES = galpixel::MOTION
      ? (RECORD'((3 << galpixel::X_VF) >> 1) << galpixel::VELOCITY_X_LSB)
      | (RECORD'((1 << galpixel::Y_VF) >> 1) << galpixel::VELOCITY_Y_LSB) : '0;

  logic [COLUMN-1:0] column;
  logic [ROW-1:0] row;
  wire last_column = {1'b0, column} + 1'b1 == columns;
  assign last = last_column && {1'b0, row} + 1'b1 == rows;
  assign at = {row, column};
  always_ff @(posedge clk)
    if (reset) {column, row} <= '0;
    else if (next) begin
      column <= last_column ? '0 : column + 1'b1;
      if (last_column) row <= last ? '0 : row + 1'b1;
    end

  // Bars of eight columns: each bit of the bar's number is a channel.
  wire [31:0] x = 32'(column);
  wire [31:0] y = 32'(row);
  logic [COLOUR-1:0] bars;
  assign bars[galpixel::CHANNEL_0_LSB +: galpixel::CHANNEL_0_BITS] = {galpixel::CHANNEL_0_BITS{x[3]}};
  if (galpixel::CHANNELS > 1) begin : colours
    assign bars[galpixel::CHANNEL_1_LSB +: galpixel::CHANNEL_1_BITS] = {galpixel::CHANNEL_1_BITS{x[4]}};
    assign bars[galpixel::CHANNEL_2_LSB +: galpixel::CHANNEL_2_BITS] = {galpixel::CHANNEL_2_BITS{x[5]}};
  end
  wire in_box = x >= 8 && x < 24 && y >= 8 && y < 20;
  wire [COLOUR-1:0] colour = !in_box ? bars : x[2] == y[2] ? '1 : ~bars;
  assign galpixel_there = (RECORD'(colour) << galpixel::COLOUR_LSB) | (in_box ? NEAR | MOVES : FAR);
endmodule
