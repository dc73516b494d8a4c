// The steps of one `step` case, one a clock through `galpix_threshold` and `galpix_step`.
`timescale 1ns / 1ps
module step;
  parameter int P = 4, VI = 10, VF = 7, AI = 8, AF = 7;
  localparam int V = VI + VF, A = AI > 0 ? AI + AF : 1, R = P > 0 ? P : 1, MOST = 8192, LATENCY = 4, CELLS = 32 - P;
  localparam int DOWN = VF + 1 > P ? VF + 1 - P : 0, T = DOWN > 0 ? DOWN : 1;

  logic clk = 0;
  logic [31:0] steps, rounding;
  logic [31:0] frame[0:MOST-1], r_of[0:MOST-1], v_of[0:MOST-1], a_of[0:MOST-1];
  logic [31:0] position[0:MOST-1], cells_of[0:MOST-1], offset[0:MOST-1], velocity[0:MOST-1], saturated[0:MOST-1];
  logic [31:0] now = '0;
  logic [T-1:0] threshold;
  logic [R-1:0] r = '0, r_1, r_next;
  logic [V-1:0] v = '0, v_1;
  logic [A-1:0] a = '0, a_1;
  logic signed [V-1:0] v_next;
  logic signed [CELLS-1:0] cells;
  logic v_saturated, r_saturated;
  string folder;
  int n, at, right, wrong;
  always #5 clk = !clk;
  always @(posedge clk) {r_1, v_1, a_1} <= {r, v, a};

  galpix_threshold #(.DOWN(DOWN)) rounded (.clk, .rounding(rounding[1:0]), .frame(now[T-1:0]), .threshold);
  galpix_step #(.P(P), .VI(VI), .VF(VF), .AI(AI), .AF(AF), .CELLS(CELLS)) dut (
      .clk, .enable(1'b1), .threshold, .r(r_1), .v(v_1), .a(a_1), .cells, .r_next, .v_next, .v_saturated, .r_saturated
  );
  wire [31:0] cells_word = 32'(cells), velocity_word = 32'(v_next);
  wire [31:0] offset_word = P > 0 ? 32'($signed(r_next)) : '0;

  task automatic compare(input string what, input logic [31:0] got, input logic [31:0] want);
    if (got === want) right++;
    else begin
      wrong++;
      if (wrong < 5) $display("step %0d, %s: %h, not %h", at, what, got, want);
    end
  endtask

  initial begin
    if (!($value$plusargs("folder=%s", folder) && $value$plusargs("steps=%d", steps)
          && $value$plusargs("rounding=%d", rounding))) $fatal(1, "an argument is missing");
    $readmemh({folder, "/frame.hex"}, frame, 0, steps - 1);
    $readmemh({folder, "/r.hex"}, r_of, 0, steps - 1);
    $readmemh({folder, "/v.hex"}, v_of, 0, steps - 1);
    $readmemh({folder, "/a.hex"}, a_of, 0, steps - 1);
    $readmemh({folder, "/position.hex"}, position, 0, steps - 1);
    $readmemh({folder, "/cells.hex"}, cells_of, 0, steps - 1);
    $readmemh({folder, "/offset.hex"}, offset, 0, steps - 1);
    $readmemh({folder, "/velocity.hex"}, velocity, 0, steps - 1);
    $readmemh({folder, "/saturated.hex"}, saturated, 0, steps - 1);
    right = 0;
    wrong = 0;
    for (n = 0; n < steps + LATENCY; n++) begin
      @(negedge clk);
      if (n >= LATENCY) begin
        at = n - LATENCY;
        compare("position", (cells_word << P) + offset_word, position[at]);
        compare("cells", cells_word, cells_of[at]);
        compare("offset", offset_word, offset[at]);
        compare("velocity", velocity_word, velocity[at]);
        compare("saturated", {31'd0, v_saturated}, saturated[at]);
      end
      if (n < steps) begin
        now = frame[n];
        r = r_of[n][R-1:0];
        v = v_of[n][V-1:0];
        a = AI > 0 ? a_of[n][A-1:0] : '0;
      end
    end
    $display("RESULT %0d %0d", right, wrong);
    $finish;
  end
endmodule
