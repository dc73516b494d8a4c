// The step of a component against section 5 of the specification, in numbers so wide that nothing is cut off. All
// states, all thresholds: what comes out is the formula's result for what went in three clocks before.
module step_proof #(
    parameter int P = 4,
    parameter int VI = 10,
    parameter int VF = 7,
    parameter int AI = 8,
    parameter int AF = 7,
    parameter bit DEPTH = 0,
    parameter int STORED = P,
    parameter int CELLS = 12,
    parameter int V = VI + VF,
    parameter int A = AI > 0 ? AI + AF : 1,
    parameter int R = STORED > 0 ? STORED : 1,
    parameter int DOWN = VF + 1 > P ? VF + 1 - P : 0,
    parameter int T = DOWN > 0 ? DOWN : 1
) (
    input logic                clk,
    input logic        [T-1:0] threshold,
    input logic        [R-1:0] r,
    input logic signed [V-1:0] v,
    input logic signed [A-1:0] a
);
  localparam int WIDE = 48;
  localparam int UP = P > VF + 1 ? P - VF - 1 : 0;
  localparam int A_UP = VF > AF ? VF - AF : 0;

  logic signed [CELLS-1:0] cells;
  logic [R-1:0] r_next;
  logic signed [V-1:0] v_next;
  logic v_saturated, r_saturated;
  galpix_step #(
      .P(P), .VI(VI), .VF(VF), .AI(AI), .AF(AF), .DEPTH(DEPTH), .STORED(STORED), .CELLS(CELLS)
  ) dut (
      .clk, .enable(1'b1), .threshold, .r, .v, .a, .cells, .r_next, .v_next, .v_saturated, .r_saturated
  );

  // The inputs of three clocks before.
  logic [T-1:0] t_1, t_2, t_3;
  logic [R-1:0] r_1, r_2, r_3;
  logic signed [V-1:0] v_1, v_2, v_3;
  logic signed [A-1:0] a_1, a_2, a_3;
  always_ff @(posedge clk) begin
    {t_1, t_2, t_3} <= {threshold, t_1, t_2};
    {r_1, r_2, r_3} <= {r, r_1, r_2};
    {v_1, v_2, v_3} <= {v, v_1, v_2};
    {a_1, a_2, a_3} <= {a, a_1, a_2};
  end

  // Section 5, line by line.
  logic signed [WIDE-1:0] position, raised, s, t, moved, w, lowest, highest, most, moved_cells, offset, clamped;
  always_comb begin
    position = DEPTH ? WIDE'($signed({1'b0, r_3})) : P > 0 ? WIDE'($signed(r_3)) : '0;
    raised = AI > 0 ? WIDE'(a_3) <<< A_UP : '0;
    s = (WIDE'(v_3) <<< 1) + raised;
    t = DOWN > 0 ? WIDE'($signed({1'b0, t_3})) : '0;
    moved = position + (((s + t) >>> DOWN) <<< UP);
    w = WIDE'(v_3) + raised;
    highest = (WIDE'(1) <<< (V - 1)) - 1;
    lowest = -highest - 1;
    moved_cells = (moved + ((WIDE'(1) <<< P) >>> 1)) >>> P;
    offset = moved - (moved_cells <<< P);
    most = (WIDE'(1) <<< R) - 1;
    clamped = moved < 0 ? '0 : moved > most ? most : moved;
  end
  wire signed [WIDE-1:0] v_expected = AI == 0 ? WIDE'(v_3) : w < lowest ? lowest : w > highest ? highest : w;

  always_comb begin
    assert (WIDE'(v_next) == v_expected);
    assert (v_saturated == (v_expected != (AI == 0 ? WIDE'(v_3) : w)));
    if (DEPTH) begin
      assert (WIDE'($signed({1'b0, r_next})) == clamped);
      assert (r_saturated == (clamped != moved));
    end else begin
      assert (WIDE'(cells) == moved_cells);
      if (P > 0) assert (WIDE'($signed(r_next)) == offset);
    end
  end
endmodule
