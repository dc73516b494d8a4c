// The frames of one `frame` case, in `galpix_frame`: every word of every map, and every count. Arguments: the case's
// folder and its parameters. With +stall the display stops at random, which must change nothing.
`timescale 1ns / 1ps
module frame;
  parameter int COLUMN = 7, ROW = 4, BAND = 4, FRONT = 4, ROUNDS = 16, RICHEST = 5;
  localparam int RECORD = galpixel::RECORD, WORDS = galpixel::WORDS;
  localparam int MOST = (1 << (COLUMN + ROW)) * WORDS;

  logic clk = 0, reset = 1, start = 0, busy, host_write = 0, host_read = 0, tvalid, tlast, tuser, misframed, beyond;
  logic tready = 1, edge_valid, edge_bit;
  logic [ROW+COLUMN-1:0] host_at = '0;
  logic [RECORD-1:0] host_data = '0, host_q, tdata;
  logic [319:0] count;
  logic [31:0] columns, rows, rounding, fill_mode, rounds, threshold, frames, reach, number;
  logic [31:0] words[0:MOST-1];
  logic [31:0] counts[0:1023];
  string folder, name;
  int cells, x, y, k, n, wrong, right, clocks, stall;
  always #5 clk = !clk;

`ifdef NETLIST
  galpix_frame dut (
`else
  galpix_frame #(
      .COLUMN(COLUMN), .ROW(ROW), .BAND(BAND), .FRONT(FRONT), .ROUNDS(ROUNDS), .RICHEST(RICHEST)
  ) dut (
`endif
      .clk, .reset, .columns(columns[COLUMN:0]), .rows(rows[ROW:0]), .reach(reach[ROW:0]), .rounding(rounding[1:0]),
      .fill_mode(fill_mode[2:0]), .rounds(rounds[4:0]), .edge_threshold(threshold), .frame(number), .start, .busy,
      .host_write, .host_read, .host_at, .host_data, .host_q, .m_axis_tvalid(tvalid), .m_axis_tready(tready),
      .m_axis_tdata(tdata), .m_axis_tlast(tlast), .m_axis_tuser(tuser), .misframed, .beyond, .count, .edge_valid,
      .edge_bit
  );
  always @(negedge clk) if (stall != 0) tready = $urandom_range(3) != 0;

  task automatic compare(input int frame_number);
    for (y = 0; y < rows; y++)
      for (x = 0; x < columns; x++) begin
        host_read = 1;
        host_at = {y[ROW-1:0], x[COLUMN-1:0]};
        @(negedge clk);
        for (k = 0; k < WORDS; k++)
          if (host_q[32*(WORDS-1-k) +: 32] === words[k*cells + y*columns + x]) right++;
          else begin
            wrong++;
            if (wrong < 5)
              $display("frame %0d, row %0d, column %0d, word %0d: %h, not %h", frame_number, y, x, k,
                       host_q[32*(WORDS-1-k) +: 32], words[k*cells + y*columns + x]);
          end
      end
    host_read = 0;
    for (k = 0; k < 10; k++)
      if (count[k*32 +: 32] === counts[10*(frame_number-1) + k]) right++;
      else begin
        wrong++;
        $display("frame %0d, count %0d: %0d, not %0d", frame_number, k, count[k*32 +: 32],
                 counts[10*(frame_number-1) + k]);
      end
  endtask

  initial begin
    if (!($value$plusargs("folder=%s", folder) && $value$plusargs("columns=%d", columns)
          && $value$plusargs("rows=%d", rows) && $value$plusargs("rounding=%d", rounding)
          && $value$plusargs("fill_mode=%d", fill_mode) && $value$plusargs("rounds=%d", rounds)
          && $value$plusargs("threshold=%d", threshold) && $value$plusargs("frame=%d", number)
          && $value$plusargs("frames=%d", frames) && $value$plusargs("reach=%d", reach))) $fatal(1, "an argument is missing");
    stall = $test$plusargs("stall");
    cells = columns * rows;
    wrong = 0;
    right = 0;
    $readmemh({folder, "/front.hex"}, words, 0, WORDS * cells - 1);
    $readmemh({folder, "/counts.hex"}, counts, 0, 10 * frames - 1);
    repeat (4) @(negedge clk);
    reset = 0;
    for (y = 0; y < rows; y++)
      for (x = 0; x < columns; x++) begin
        host_write = 1;
        host_at = {y[ROW-1:0], x[COLUMN-1:0]};
        for (k = 0; k < WORDS; k++) host_data[32*(WORDS-1-k) +: 32] = words[k*cells + y*columns + x];
        @(negedge clk);
      end
    host_write = 0;
    while (!dut.stream.band_ready) @(negedge clk);
    for (n = 1; n <= frames; n++) begin
      clocks = 0;
      start = 1;
      @(negedge clk);
      start = 0;
      while (busy) begin
        @(negedge clk);
        clocks++;
        if (clocks > 100 * cells + 100000) $fatal(1, "frame %0d does not end", n);
      end
      $sformat(name, "%s/map_%0d.hex", folder, n);
      $readmemh(name, words, 0, WORDS * cells - 1);
      compare(n);
      number++;
    end
    if (misframed || beyond) begin
      wrong++;
      $display("misframed %b, beyond the reach %b", misframed, beyond);
    end
    $display("RESULT %0d %0d clocks %0d cells %0d", right, wrong, clocks, cells);
    $finish;
  end
endmodule
