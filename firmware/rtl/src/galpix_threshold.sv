// The rounding threshold of one component (specification, section 5), one clock after the frame counter. One of these
// serves any number of lanes, for it is the same in all of a frame.
module galpix_threshold #(
    parameter int DOWN = 4,                    // bits that a step drops; 0: the threshold is 0
    parameter int BITS = DOWN > 0 ? DOWN : 1
) (
    input  logic            clk,
    input  logic [1:0]      rounding,          // 0 truncate, 1 nearest, 2 low-discrepancy, 3 searched
    input  logic [BITS-1:0] frame,             // the low bits of the frame counter
    output logic [BITS-1:0] threshold
);
  // The searched tables, entry n at bits n * DOWN and up.
  localparam logic [1:0] TABLE_1 = 2'h1;
  localparam logic [7:0] TABLE_2 = 8'h66;
  localparam logic [23:0] TABLE_3 = 24'h3a38ce;
  localparam logic [63:0] TABLE_4 = 64'hcf3b748847b3fc0;
  localparam logic [159:0] TABLE_5 = 160'h25cbd4d36137da59ee4971eadd8d72b43d50307a;
  localparam logic [383:0] TABLE_6 =
      384'h33b94382f6be11a74ade7a176d25a2c3f4ac4cabd9a3545fb21052fcf11493ade96072f8f33e0041dc8fea53b81d7787;

  logic [BITS-1:0] reversed, searched;

  for (genvar bit_of = 0; bit_of < BITS; bit_of++) begin : reverse
    assign reversed[bit_of] = frame[BITS-1-bit_of];
  end

  if (DOWN == 1) begin : one
    assign searched = TABLE_1[frame +: 1];
  end else if (DOWN == 2) begin : two
    assign searched = TABLE_2[3'(frame) * 3'd2 +: 2];
  end else if (DOWN == 3) begin : three
    assign searched = TABLE_3[5'(frame) * 5'd3 +: 3];
  end else if (DOWN == 4) begin : four
    assign searched = TABLE_4[6'(frame) * 6'd4 +: 4];
  end else if (DOWN == 5) begin : five
    assign searched = TABLE_5[8'(frame) * 8'd5 +: 5];
  end else if (DOWN == 6) begin : six
    assign searched = TABLE_6[9'(frame) * 9'd6 +: 6];
  end else begin : none
    assign searched = reversed;
  end

  always_ff @(posedge clk)
    if (DOWN == 0) threshold <= '0;
    else
      case (rounding)
        2'd0: threshold <= '0;
        2'd1: threshold <= {1'b1, {(BITS - 1) {1'b0}}};
        2'd2: threshold <= reversed;
        default: threshold <= searched;
      endcase
endmodule
