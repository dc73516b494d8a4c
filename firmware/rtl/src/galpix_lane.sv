// The step of a whole galpixel (specification, section 5): one a clock, three clocks long. Adders and shifts by
// constants alone. The widths and places of the fields are those of the package `galpixel`.
module galpix_lane #(
    parameter int X_T = galpixel::X_VF + 1 > galpixel::X_P ? galpixel::X_VF + 1 - galpixel::X_P : 1,
    parameter int Y_T = galpixel::Y_VF + 1 > galpixel::Y_P ? galpixel::Y_VF + 1 - galpixel::Y_P : 1,
    parameter int Z_T = galpixel::Z_VF + 1 > galpixel::Z_P ? galpixel::Z_VF + 1 - galpixel::Z_P : 1
) (
    input  logic                                clk,
    input  logic                                enable,
    input  logic        [X_T-1:0]               x_threshold,
    input  logic        [Y_T-1:0]               y_threshold,
    input  logic        [Z_T-1:0]               z_threshold,
    input  logic        [galpixel::RECORD-1:0]  given,
    output logic        [galpixel::RECORD-1:0]  after,
    output logic signed [galpixel::X_CELLS-1:0] x_cells,
    output logic signed [galpixel::Y_CELLS-1:0] y_cells,
    output logic        [2:0]                   saturated      // fields
);
  localparam int RECORD = galpixel::RECORD;

  // What the three clocks leave as it is.
  logic [RECORD-1:0] before_1, before_2, before_3;
  always_ff @(posedge clk)
    if (enable) begin
      before_1 <= given;
      before_2 <= before_1;
      before_3 <= before_2;
    end

  // An absent field stands here as one bit that nobody looks at.
  localparam int DEPTH = galpixel::DEPTH_BITS > 0 ? galpixel::DEPTH_BITS : 1;
  localparam int X_R = galpixel::OFFSET_X_BITS > 0 ? galpixel::OFFSET_X_BITS : 1;
  localparam int Y_R = galpixel::OFFSET_Y_BITS > 0 ? galpixel::OFFSET_Y_BITS : 1;
  localparam int X_V = galpixel::MOTION ? galpixel::VELOCITY_X_BITS : 1;
  localparam int Y_V = galpixel::MOTION ? galpixel::VELOCITY_Y_BITS : 1;
  localparam int Z_V = galpixel::DEPTH_MOTION ? galpixel::VELOCITY_DEPTH_BITS : 1;
  localparam int X_A = galpixel::X_AI > 0 ? galpixel::X_AI + galpixel::X_AF : 1;
  localparam int Y_A = galpixel::Y_AI > 0 ? galpixel::Y_AI + galpixel::Y_AF : 1;
  localparam int Z_A = galpixel::Z_AI > 0 ? galpixel::Z_AI + galpixel::Z_AF : 1;
  logic [X_R-1:0] x_r;
  logic [Y_R-1:0] y_r;
  logic [DEPTH-1:0] z_r;
  logic [X_V-1:0] x_v;
  logic [Y_V-1:0] y_v;
  logic [Z_V-1:0] z_v;
  logic x_clamped, y_clamped, z_clamped, depth_clamped;

  if (galpixel::MOTION) begin : plane
    logic x_unused, y_unused;
    galpix_step #(
        .P(galpixel::X_P), .VI(galpixel::X_VI), .VF(galpixel::X_VF), .AI(galpixel::X_AI), .AF(galpixel::X_AF),
        .CELLS(galpixel::X_CELLS)
    ) x (
        .clk, .enable, .threshold(x_threshold),
        .r(given[galpixel::OFFSET_X_LSB +: X_R]),
        .v(given[galpixel::VELOCITY_X_LSB +: X_V]),
        .a(given[galpixel::ACCELERATION_X_LSB +: X_A]),
        .cells(x_cells), .r_next(x_r), .v_next(x_v), .v_saturated(x_clamped), .r_saturated(x_unused)
    );
    galpix_step #(
        .P(galpixel::Y_P), .VI(galpixel::Y_VI), .VF(galpixel::Y_VF), .AI(galpixel::Y_AI), .AF(galpixel::Y_AF),
        .CELLS(galpixel::Y_CELLS)
    ) y (
        .clk, .enable, .threshold(y_threshold),
        .r(given[galpixel::OFFSET_Y_LSB +: Y_R]),
        .v(given[galpixel::VELOCITY_Y_LSB +: Y_V]),
        .a(given[galpixel::ACCELERATION_Y_LSB +: Y_A]),
        .cells(y_cells), .r_next(y_r), .v_next(y_v), .v_saturated(y_clamped), .r_saturated(y_unused)
    );
    wire unused = &{1'b0, x_unused, y_unused};
  end else begin : still
    assign {x_cells, y_cells, x_r, y_r, x_v, y_v, x_clamped, y_clamped} = '0;
    wire unused = &{1'b0, x_threshold, y_threshold};
  end

  if (galpixel::DEPTH_MOTION) begin : depth
    logic cells;
    galpix_step #(
        .P(galpixel::Z_P), .VI(galpixel::Z_VI), .VF(galpixel::Z_VF), .AI(galpixel::Z_AI), .AF(galpixel::Z_AF),
        .DEPTH(1), .STORED(DEPTH), .CELLS(1)
    ) z (
        .clk, .enable, .threshold(z_threshold),
        .r(given[galpixel::DEPTH_LSB +: DEPTH]),
        .v(given[galpixel::VELOCITY_DEPTH_LSB +: Z_V]),
        .a(given[galpixel::ACCELERATION_DEPTH_LSB +: Z_A]),
        .cells(cells), .r_next(z_r), .v_next(z_v), .v_saturated(z_clamped), .r_saturated(depth_clamped)
    );
    wire unused = &{1'b0, cells};
  end else begin : flat
    assign {z_r, z_v, z_clamped, depth_clamped} = '0;
    wire unused = &{1'b0, z_threshold};
  end

  assign saturated = 3'(x_clamped) + 3'(y_clamped) + 3'(z_clamped) + 3'(depth_clamped);

  // Shading inertia: the level in clock 1, the channels in clock 3.
  localparam int COLOUR = galpixel::COLOUR_BITS;
  localparam int FRACTION = galpixel::LUMINOSITY_BITS > 0 ? galpixel::LUMINOSITY_BITS : 1;
  logic [FRACTION-1:0] luminosity;
  logic [COLOUR-1:0] colour;

  if (galpixel::SHADING) begin : shading
    localparam int LF = galpixel::LUMINOSITY_BITS;
    localparam int RATE = galpixel::LUMINOSITY_RATE_BITS;
    localparam int LEVEL = (RATE > LF + 1 ? RATE : LF + 1) + 1;
    localparam int STEPS = LEVEL - LF;
    logic [FRACTION-1:0] stored, luminosity_2;
    logic signed [LEVEL-1:0] level;
    logic signed [STEPS-1:0] steps;
    assign stored = LF > 0 ? before_1[galpixel::LUMINOSITY_LSB +: FRACTION] : '0;
    assign level = LEVEL'($signed(before_1[galpixel::LUMINOSITY_RATE_LSB +: RATE])) + LEVEL'($signed({1'b0, stored}));
    always_ff @(posedge clk)
      if (enable) begin
        steps <= STEPS'(level >>> LF);
        luminosity_2 <= level[FRACTION-1:0];
        luminosity <= luminosity_2;
      end
    galpix_channel #(
        .BITS(galpixel::CHANNEL_0_BITS), .UP(galpixel::CHANNEL_0_BITS - galpixel::NARROWEST), .STEPS(STEPS)
    ) first (
        .clk, .enable, .steps,
        .given(before_2[galpixel::COLOUR_LSB + galpixel::CHANNEL_0_LSB +: galpixel::CHANNEL_0_BITS]),
        .after(colour[galpixel::CHANNEL_0_LSB +: galpixel::CHANNEL_0_BITS])
    );
    if (galpixel::CHANNELS > 1) begin : others
      galpix_channel #(
          .BITS(galpixel::CHANNEL_1_BITS), .UP(galpixel::CHANNEL_1_BITS - galpixel::NARROWEST), .STEPS(STEPS)
      ) second (
          .clk, .enable, .steps,
          .given(before_2[galpixel::COLOUR_LSB + galpixel::CHANNEL_1_LSB +: galpixel::CHANNEL_1_BITS]),
          .after(colour[galpixel::CHANNEL_1_LSB +: galpixel::CHANNEL_1_BITS])
      );
      galpix_channel #(
          .BITS(galpixel::CHANNEL_2_BITS), .UP(galpixel::CHANNEL_2_BITS - galpixel::NARROWEST), .STEPS(STEPS)
      ) third (
          .clk, .enable, .steps,
          .given(before_2[galpixel::COLOUR_LSB + galpixel::CHANNEL_2_LSB +: galpixel::CHANNEL_2_BITS]),
          .after(colour[galpixel::CHANNEL_2_LSB +: galpixel::CHANNEL_2_BITS])
      );
    end
  end else begin : unshaded
    assign luminosity = '0;
    assign colour = before_3[galpixel::COLOUR_LSB +: COLOUR];
  end

  // The new fields in their places; `CHANGED` is where they are.
  localparam logic [RECORD-1:0] CLASS = RECORD'(2'd3) << galpixel::CLASS_LSB;
  localparam logic [RECORD-1:0] CHANGED = CLASS
      | (galpixel::SHADING ? RECORD'({COLOUR{1'b1}}) << galpixel::COLOUR_LSB : '0)
      | (galpixel::LUMINOSITY_BITS > 0 ? RECORD'({FRACTION{1'b1}}) << galpixel::LUMINOSITY_LSB : '0)
      | (galpixel::OFFSET_X_BITS > 0 ? RECORD'({X_R{1'b1}}) << galpixel::OFFSET_X_LSB : '0)
      | (galpixel::OFFSET_Y_BITS > 0 ? RECORD'({Y_R{1'b1}}) << galpixel::OFFSET_Y_LSB : '0)
      | (galpixel::MOTION ? RECORD'({X_V{1'b1}}) << galpixel::VELOCITY_X_LSB : '0)
      | (galpixel::MOTION ? RECORD'({Y_V{1'b1}}) << galpixel::VELOCITY_Y_LSB : '0)
      | (galpixel::DEPTH_MOTION ? RECORD'({DEPTH{1'b1}}) << galpixel::DEPTH_LSB : '0)
      | (galpixel::DEPTH_MOTION ? RECORD'({Z_V{1'b1}}) << galpixel::VELOCITY_DEPTH_LSB : '0);
  wire [1:0] class_3 = before_3[galpixel::CLASS_LSB +: 2];
  wire [1:0] aged = class_3 == 2'd1 ? 2'd2 : class_3;
  wire [RECORD-1:0] changed = (RECORD'(aged) << galpixel::CLASS_LSB)
      | (galpixel::SHADING ? RECORD'(colour) << galpixel::COLOUR_LSB : '0)
      | (galpixel::LUMINOSITY_BITS > 0 ? RECORD'(luminosity) << galpixel::LUMINOSITY_LSB : '0)
      | (galpixel::OFFSET_X_BITS > 0 ? RECORD'(x_r) << galpixel::OFFSET_X_LSB : '0)
      | (galpixel::OFFSET_Y_BITS > 0 ? RECORD'(y_r) << galpixel::OFFSET_Y_LSB : '0)
      | (galpixel::MOTION ? RECORD'(x_v) << galpixel::VELOCITY_X_LSB : '0)
      | (galpixel::MOTION ? RECORD'(y_v) << galpixel::VELOCITY_Y_LSB : '0)
      | (galpixel::DEPTH_MOTION ? RECORD'(z_r) << galpixel::DEPTH_LSB : '0)
      | (galpixel::DEPTH_MOTION ? RECORD'(z_v) << galpixel::VELOCITY_DEPTH_LSB : '0);
  assign after = (before_3 & galpixel::USED & ~CHANGED) | changed;
endmodule
