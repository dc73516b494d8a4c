// The step of one component (specification, section 5): one a clock, three clocks long.
//
//   clock 1   w = v + a'                 h = v + threshold              a' = a << A_UP
//   clock 2   s + threshold = w + h      v' = w, or the end of its range
//   clock 3   r' = r + (((s + threshold) >> DOWN) << UP)
//
// 2v + a' + threshold has three terms; as w + h it needs no adder of its own for the three. An offset is added to as
// r + 1/2 cell, which is r with its sign bit inverted: what is carried out of it is the nearest cell, halves upwards.
module galpix_step #(
    parameter int P = 4,                       // position_frac of section 5; for a depth that of its field
    parameter int VI = 10,
    parameter int VF = 7,
    parameter int AI = 8,                      // 0: no acceleration
    parameter int AF = 7,
    parameter bit DEPTH = 0,                   // the position is a depth of STORED bits, not an offset of P
    parameter int STORED = P,
    parameter int CELLS = 12,                  // bits of the cells moved
    // what follows from these
    parameter int V = VI + VF,
    parameter int A = AI > 0 ? AI + AF : 1,
    parameter int R = STORED > 0 ? STORED : 1,
    parameter int DOWN = VF + 1 > P ? VF + 1 - P : 0,
    parameter int T = DOWN > 0 ? DOWN : 1
) (
    input  logic                    clk,
    input  logic                    enable,
    input  logic        [T-1:0]     threshold,
    input  logic        [R-1:0]     r,
    input  logic signed [V-1:0]     v,
    input  logic signed [A-1:0]     a,
    output logic signed [CELLS-1:0] cells,     // 0 for a depth
    output logic        [R-1:0]     r_next,
    output logic signed [V-1:0]     v_next,
    output logic                    v_saturated,
    output logic                    r_saturated
);
  localparam int UP = P > VF + 1 ? P - VF - 1 : 0;
  localparam int A_UP = VF > AF ? VF - AF : 0;
  localparam int RAISED = AI > 0 ? A + A_UP : 1;
  localparam int W = (V > RAISED ? V : RAISED) + 1;
  localparam int H = (V > T + 1 ? V : T + 1) + 1;
  localparam int S = (W > H ? W : H) + 1;
  localparam int DELTA = S - DOWN + UP;
  localparam int MOST = DELTA > R + 1 ? DELTA : R + 1;
  localparam int N = (MOST > P + CELLS ? MOST : P + CELLS) + 1;

  // Clock 1.
  logic signed [W-1:0] raised, w;
  logic signed [H-1:0] h;
  logic [R-1:0] r_1, r_2;
  assign raised = AI > 0 ? W'(a) <<< A_UP : '0;

  always_ff @(posedge clk)
    if (enable) begin
      w <= W'(v) + raised;
      h <= H'(v) + (DOWN > 0 ? H'($signed({1'b0, threshold})) : '0);
      r_1 <= r;
    end

  // Clock 2.
  logic signed [S-1:0] s;
  logic signed [V-1:0] v_2;
  logic beyond, beyond_2;
  assign beyond = AI > 0 && w[W-1:V-1] != {(W - V + 1) {w[W-1]}};

  always_ff @(posedge clk)
    if (enable) begin
      s <= S'(w) + S'(h);
      r_2 <= r_1;
      beyond_2 <= beyond;
      v_2 <= beyond ? {w[W-1], {(V - 1) {!w[W-1]}}} : w[V-1:0];
    end

  // Clock 3.
  logic signed [N-1:0] delta, n;
  assign delta = N'($signed(s[S-1:DOWN])) <<< UP;
  wire unused = &{1'b0, s};

  if (DEPTH) begin : depth
    assign n = N'($signed({1'b0, r_2})) + delta;
    wire below = n[N-1];
    wire above = !below && |n[N-2:R];
    always_ff @(posedge clk)
      if (enable) begin
        cells <= '0;
        r_next <= below ? '0 : above ? '1 : n[R-1:0];
        r_saturated <= below || above;
      end
  end else if (P == 0) begin : whole
    assign n = delta;
    wire unused_offset = &{1'b0, r_2, n};
    always_ff @(posedge clk)
      if (enable) begin
        cells <= CELLS'(n);
        r_next <= '0;
        r_saturated <= 1'b0;
      end
  end else begin : offset
    localparam logic [R-1:0] HALF = {1'b1, {(R - 1) {1'b0}}};
    assign n = N'($signed({1'b0, r_2 ^ HALF})) + delta;
    always_ff @(posedge clk)
      if (enable) begin
        cells <= CELLS'(n >>> P);
        r_next <= n[R-1:0] ^ HALF;
        r_saturated <= 1'b0;
      end
  end

  always_ff @(posedge clk)
    if (enable) begin
      v_next <= v_2;
      v_saturated <= beyond_2;
    end
endmodule
