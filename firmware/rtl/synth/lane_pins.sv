// Few pins around a lane, for place and route: the galpixel comes in bit by bit and leaves as one bit.
module lane_pins (
    input  logic clk,
    input  logic d,
    input  logic load,
    output logic q
);
  localparam int RECORD = galpixel::RECORD;
  localparam int X_T = galpixel::X_VF + 1 > galpixel::X_P ? galpixel::X_VF + 1 - galpixel::X_P : 1;
  localparam int Y_T = galpixel::Y_VF + 1 > galpixel::Y_P ? galpixel::Y_VF + 1 - galpixel::Y_P : 1;
  localparam int Z_T = galpixel::Z_VF + 1 > galpixel::Z_P ? galpixel::Z_VF + 1 - galpixel::Z_P : 1;
  logic [RECORD-1:0] given, after, shifted;
  logic [X_T+Y_T+Z_T-1:0] thresholds;
  logic signed [galpixel::X_CELLS-1:0] x_cells;
  logic signed [galpixel::Y_CELLS-1:0] y_cells;
  logic [2:0] saturated;
  logic folded, load_1;
  always_ff @(posedge clk) begin
    given <= {given[RECORD-2:0], d};
    thresholds <= {thresholds[X_T+Y_T+Z_T-2:0], given[RECORD-1]};
    load_1 <= load;
    folded <= ^{x_cells, y_cells, saturated};
    shifted <= load_1 ? after : {shifted[RECORD-2:0], folded};
    q <= shifted[RECORD-1];
  end
  galpix_lane lane (
      .clk, .enable(1'b1), .x_threshold(thresholds[X_T-1:0]), .y_threshold(thresholds[X_T +: Y_T]),
      .z_threshold(thresholds[X_T+Y_T +: Z_T]), .given, .after, .x_cells, .y_cells, .saturated
  );
endmodule
