// The galpixels of one `propagate` case, one a clock through `galpix_threshold` and `galpix_lane`.
`timescale 1ns / 1ps
module propagate;
  localparam int RECORD = galpixel::RECORD, WORDS = galpixel::WORDS, MOST = 1024, LATENCY = 4;
  localparam int X_DOWN = galpixel::X_VF + 1 > galpixel::X_P ? galpixel::X_VF + 1 - galpixel::X_P : 0;
  localparam int Y_DOWN = galpixel::Y_VF + 1 > galpixel::Y_P ? galpixel::Y_VF + 1 - galpixel::Y_P : 0;
  localparam int Z_DOWN = galpixel::Z_VF + 1 > galpixel::Z_P ? galpixel::Z_VF + 1 - galpixel::Z_P : 0;
  localparam int X_T = X_DOWN > 0 ? X_DOWN : 1, Y_T = Y_DOWN > 0 ? Y_DOWN : 1, Z_T = Z_DOWN > 0 ? Z_DOWN : 1;

  logic clk = 0;
  logic [31:0] galpixels, rounding, now = '0, words[0:MOST*WORDS-1], expected[0:MOST*WORDS-1], frames[0:MOST-1];
  logic [31:0] x_expected[0:MOST-1], y_expected[0:MOST-1], saturated_expected[0:MOST-1];
  logic [RECORD-1:0] given = '0, given_1, after;
  logic [X_T-1:0] x_threshold;
  logic [Y_T-1:0] y_threshold;
  logic [Z_T-1:0] z_threshold;
  logic signed [galpixel::X_CELLS-1:0] x_cells;
  logic signed [galpixel::Y_CELLS-1:0] y_cells;
  logic [2:0] saturated;
  string folder;
  int n, k, right, wrong;
  always #5 clk = !clk;
  always @(posedge clk) given_1 <= given;

  galpix_threshold #(.DOWN(X_DOWN)) of_x (.clk, .rounding(rounding[1:0]), .frame(now[X_T-1:0]), .threshold(x_threshold));
  galpix_threshold #(.DOWN(Y_DOWN)) of_y (.clk, .rounding(rounding[1:0]), .frame(now[Y_T-1:0]), .threshold(y_threshold));
  galpix_threshold #(.DOWN(Z_DOWN)) of_z (.clk, .rounding(rounding[1:0]), .frame(now[Z_T-1:0]), .threshold(z_threshold));
  galpix_lane dut (
      .clk, .enable(1'b1), .x_threshold, .y_threshold, .z_threshold, .given(given_1), .after, .x_cells, .y_cells,
      .saturated
  );
  wire [31:0] x_moved = 32'(x_cells), y_moved = 32'(y_cells);

  task automatic compare(input string what, input logic [31:0] got, input logic [31:0] want);
    if (got === want) right++;
    else begin
      wrong++;
      if (wrong < 5) $display("galpixel %0d, %s: %h, not %h", n - LATENCY, what, got, want);
    end
  endtask

  initial begin
    if (!($value$plusargs("folder=%s", folder) && $value$plusargs("galpixels=%d", galpixels)
          && $value$plusargs("rounding=%d", rounding))) $fatal(1, "an argument is missing");
    $readmemh({folder, "/frame.hex"}, frames, 0, galpixels - 1);
    $readmemh({folder, "/before.hex"}, words, 0, WORDS * galpixels - 1);
    $readmemh({folder, "/after.hex"}, expected, 0, WORDS * galpixels - 1);
    $readmemh({folder, "/x_cells.hex"}, x_expected, 0, galpixels - 1);
    $readmemh({folder, "/y_cells.hex"}, y_expected, 0, galpixels - 1);
    $readmemh({folder, "/saturated.hex"}, saturated_expected, 0, galpixels - 1);
    right = 0;
    wrong = 0;
    for (n = 0; n < galpixels + LATENCY; n++) begin
      @(negedge clk);
      if (n >= LATENCY) begin
        for (k = 0; k < WORDS; k++)
          compare($sformatf("word %0d", k), after[32*(WORDS-1-k) +: 32], expected[(n-LATENCY)*WORDS + k]);
        compare("cells of x", x_moved, x_expected[n-LATENCY]);
        compare("cells of y", y_moved, y_expected[n-LATENCY]);
        compare("saturated", 32'(saturated), saturated_expected[n-LATENCY]);
      end
      if (n < galpixels) begin
        now = frames[n];
        for (k = 0; k < WORDS; k++) given[32*(WORDS-1-k) +: 32] = words[n*WORDS + k];
      end
    end
    $display("RESULT %0d %0d", right, wrong);
    $finish;
  end
endmodule
