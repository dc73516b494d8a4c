// The mean of four galpixels, field by field (specification, section 10), two clocks long. The mean of two is that of
// p, p, q, q, and a copy that of p, p, p, p. Class, tag and luminosity are those of p.
module galpix_mean (
    input  logic                        clk,
    input  logic                        enable,
    input  logic [galpixel::RECORD-1:0] p,
    input  logic [galpixel::RECORD-1:0] q,
    input  logic [galpixel::RECORD-1:0] r,
    input  logic [galpixel::RECORD-1:0] s,
    output logic [galpixel::RECORD-1:0] mean
);
  localparam int RECORD = galpixel::RECORD;

  logic [RECORD-1:0] first, first_2, averaged, mask;
  always_ff @(posedge clk)
    if (enable) begin
      first <= p & galpixel::USED;
      first_2 <= first;
    end
  assign mean = (first_2 & ~mask) | averaged;

  // One field at the place LSB. Its result and its mask stand in a record of their own; they are joined below.
  localparam int FIELDS = 13;
  logic [FIELDS*RECORD-1:0] results, masks;
  galpix_mean_field #(.BITS(galpixel::DEPTH_BITS), .LSB(galpixel::DEPTH_LSB), .SIGNED(0))
      depth (.clk, .enable, .p, .q, .r, .s, .result(results[0*RECORD +: RECORD]), .mask(masks[0*RECORD +: RECORD]));
  galpix_mean_field #(.BITS(galpixel::OFFSET_X_BITS), .LSB(galpixel::OFFSET_X_LSB), .SIGNED(1))
      offset_x (.clk, .enable, .p, .q, .r, .s, .result(results[1*RECORD +: RECORD]), .mask(masks[1*RECORD +: RECORD]));
  galpix_mean_field #(.BITS(galpixel::OFFSET_Y_BITS), .LSB(galpixel::OFFSET_Y_LSB), .SIGNED(1))
      offset_y (.clk, .enable, .p, .q, .r, .s, .result(results[2*RECORD +: RECORD]), .mask(masks[2*RECORD +: RECORD]));
  galpix_mean_field #(.BITS(galpixel::VELOCITY_X_BITS), .LSB(galpixel::VELOCITY_X_LSB), .SIGNED(1))
      velocity_x (.clk, .enable, .p, .q, .r, .s, .result(results[3*RECORD +: RECORD]), .mask(masks[3*RECORD +: RECORD]));
  galpix_mean_field #(.BITS(galpixel::VELOCITY_Y_BITS), .LSB(galpixel::VELOCITY_Y_LSB), .SIGNED(1))
      velocity_y (.clk, .enable, .p, .q, .r, .s, .result(results[4*RECORD +: RECORD]), .mask(masks[4*RECORD +: RECORD]));
  galpix_mean_field #(.BITS(galpixel::VELOCITY_DEPTH_BITS), .LSB(galpixel::VELOCITY_DEPTH_LSB), .SIGNED(1))
      velocity_depth (.clk, .enable, .p, .q, .r, .s, .result(results[5*RECORD +: RECORD]), .mask(masks[5*RECORD +: RECORD]));
  galpix_mean_field #(.BITS(galpixel::ACCELERATION_X_BITS), .LSB(galpixel::ACCELERATION_X_LSB), .SIGNED(1))
      acceleration_x (.clk, .enable, .p, .q, .r, .s, .result(results[6*RECORD +: RECORD]), .mask(masks[6*RECORD +: RECORD]));
  galpix_mean_field #(.BITS(galpixel::ACCELERATION_Y_BITS), .LSB(galpixel::ACCELERATION_Y_LSB), .SIGNED(1))
      acceleration_y (.clk, .enable, .p, .q, .r, .s, .result(results[7*RECORD +: RECORD]), .mask(masks[7*RECORD +: RECORD]));
  galpix_mean_field #(.BITS(galpixel::ACCELERATION_DEPTH_BITS), .LSB(galpixel::ACCELERATION_DEPTH_LSB), .SIGNED(1))
      acceleration_depth (.clk, .enable, .p, .q, .r, .s, .result(results[8*RECORD +: RECORD]), .mask(masks[8*RECORD +: RECORD]));
  galpix_mean_field #(.BITS(galpixel::LUMINOSITY_RATE_BITS), .LSB(galpixel::LUMINOSITY_RATE_LSB), .SIGNED(1))
      luminosity_rate (.clk, .enable, .p, .q, .r, .s, .result(results[9*RECORD +: RECORD]), .mask(masks[9*RECORD +: RECORD]));
  galpix_mean_field #(
      .BITS(galpixel::CHANNEL_0_BITS), .LSB(galpixel::COLOUR_LSB + galpixel::CHANNEL_0_LSB), .SIGNED(0)
  ) channel_0 (.clk, .enable, .p, .q, .r, .s, .result(results[10*RECORD +: RECORD]), .mask(masks[10*RECORD +: RECORD]));
  galpix_mean_field #(
      .BITS(galpixel::CHANNEL_1_BITS), .LSB(galpixel::COLOUR_LSB + galpixel::CHANNEL_1_LSB), .SIGNED(0)
  ) channel_1 (.clk, .enable, .p, .q, .r, .s, .result(results[11*RECORD +: RECORD]), .mask(masks[11*RECORD +: RECORD]));
  galpix_mean_field #(
      .BITS(galpixel::CHANNEL_2_BITS), .LSB(galpixel::COLOUR_LSB + galpixel::CHANNEL_2_LSB), .SIGNED(0)
  ) channel_2 (.clk, .enable, .p, .q, .r, .s, .result(results[12*RECORD +: RECORD]), .mask(masks[12*RECORD +: RECORD]));

  always_comb begin
    averaged = '0;
    mask = '0;
    for (int field = 0; field < FIELDS; field++) begin
      averaged |= results[field*RECORD +: RECORD];
      mask |= masks[field*RECORD +: RECORD];
    end
  end
endmodule
