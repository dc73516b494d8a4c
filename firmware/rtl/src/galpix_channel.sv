// One channel of a colour that brightens (specification, section 5, luminosity), a clock later.
module galpix_channel #(
    parameter int BITS = 8,
    parameter int UP = 0,                      // bits by which it is wider than the narrowest channel
    parameter int STEPS = 8                    // bits of the whole steps
) (
    input  logic                    clk,
    input  logic                    enable,
    input  logic signed [STEPS-1:0] steps,
    input  logic        [BITS-1:0]  given,
    output logic        [BITS-1:0]  after
);
  localparam int SUM = (STEPS + UP > BITS + 1 ? STEPS + UP : BITS + 1) + 1;
  logic signed [SUM-1:0] sum;
  assign sum = SUM'($signed({1'b0, given})) + (SUM'(steps) <<< UP);
  always_ff @(posedge clk)
    if (enable) after <= sum[SUM-1] ? '0 : |sum[SUM-2:BITS] ? '1 : sum[BITS-1:0];
endmodule
