// The edge map of one `edge` case, from `galpix_window` and `galpix_edge`.
`timescale 1ns / 1ps
module edges;
  parameter int COLUMN = 7, ROW = 4;
  localparam int RECORD = galpixel::RECORD, WORDS = galpixel::WORDS, MOST = 1 << (COLUMN + ROW);
  localparam int DEPTH = galpixel::DEPTH_BITS > 0 ? galpixel::DEPTH_BITS : 1, KEY = DEPTH + 2;

  logic clk = 0, reset = 1, valid = 0, window, done, next, on_edge;
  logic [31:0] columns, rows, threshold, words[0:MOST*WORDS-1], expected[0:MOST/32-1], counts[0:9];
  logic [RECORD-1:0] record = '0;
  logic [3:0] has;
  logic [2:0] there = '0;
  logic [COLUMN-1:0] column;
  logic [ROW-1:0] row;
  logic [ROW+COLUMN-1:0] next_at;
  logic [KEY-1:0] key, above_left, above, above_right, left, centre, right_one, below_left, below, below_right;
  string folder;
  int cells, n, k, at, right, wrong, set;
  always #5 clk = !clk;
  assign key[DEPTH +: 2] = record[galpixel::CLASS_LSB +: 2];
  assign key[DEPTH-1:0] = galpixel::DEPTH_BITS > 0 ? record[galpixel::DEPTH_LSB +: DEPTH] : '0;

  galpix_window #(.BITS(KEY), .COLUMN(COLUMN), .ROW(ROW)) keys (
      .clk, .reset, .enable(1'b1), .columns(columns[COLUMN:0]), .rows(rows[ROW:0]), .valid, .item(key), .window, .column,
      .row, .has, .above_left, .above, .above_right, .beside_left(left), .centre, .beside_right(right_one), .below_left,
      .below, .below_right, .done, .next, .next_at
  );
  galpix_edge #(.DEPTH(DEPTH)) dut (
      .clk, .enable(1'b1), .threshold, .has, .centre, .left, .right(right_one), .above, .below, .on_edge
  );
  always @(posedge clk) there <= reset ? '0 : {there[1:0], window};

  always @(negedge clk)
    if (there[2] && !reset) begin
      if (on_edge === expected[at/32][at%32]) right++;
      else begin
        wrong++;
        if (wrong < 5) $display("cell %0d: %b", at, on_edge);
      end
      set += 32'(on_edge);
      at++;
    end

  initial begin
    if (!($value$plusargs("folder=%s", folder) && $value$plusargs("columns=%d", columns)
          && $value$plusargs("rows=%d", rows) && $value$plusargs("threshold=%d", threshold))) $fatal(1, "an argument is missing");
    cells = columns * rows;
    {at, right, wrong, set} = '0;
    $readmemh({folder, "/front.hex"}, words, 0, WORDS * cells - 1);
    $readmemh({folder, "/edges.hex"}, expected, 0, (cells + 31) / 32 - 1);
    $readmemh({folder, "/counts.hex"}, counts, 0, 9);
    repeat (4) @(negedge clk);
    reset = 0;
    for (n = 0; n < cells; n++) begin
      // With a gap now and then, which must change nothing.
      while ($urandom_range(4) == 0) @(negedge clk);
      valid = 1;
      for (k = 0; k < WORDS; k++) record[32*(WORDS-1-k) +: 32] = words[k*cells + n];
      @(negedge clk);
      valid = 0;
    end
    repeat (columns + 16) @(negedge clk);
    if (at != cells || set != counts[4]) begin
      wrong++;
      $display("%0d cells, %0d of them edges, not %0d, %0d", at, set, cells, counts[4]);
    end else right++;
    $display("RESULT %0d %0d", right, wrong);
    $finish;
  end
endmodule
