// The panel of `galpix_panel`: draws what it is sent, frame by frame, as text: width, height, then a pixel a line.
// The panel is slow now and then.
`timescale 1ns / 1ps
module panel;
  parameter int FRAMES = 4;
  logic clk = 0, reset = 1, vsync = 0, ready, tvalid, tready = 1, tlast, tuser;
  logic [23:0] tdata;
  string out;
  int file, frame, column, row, width, waited;
  always #5 clk = !clk;
  always @(negedge clk) tready = $urandom_range(7) != 0;

  galpix_panel dut (
      .clk, .reset, .vsync, .ready, .m_axis_tvalid(tvalid), .m_axis_tready(tready), .m_axis_tdata(tdata),
      .m_axis_tlast(tlast), .m_axis_tuser(tuser)
  );

  always @(posedge clk)
    if (!reset && tvalid && tready) begin
      if (tuser != (row == 0 && column == 0)) $fatal(1, "tuser at row %0d, column %0d", row, column);
      $fdisplay(file, "%h", tdata);
      column++;
      if (tlast) begin
        if (row > 0 && column != width) $fatal(1, "row %0d has %0d pixels, not %0d", row, column, width);
        width = column;
        column = 0;
        row++;
      end
    end

  initial begin
    if (!$value$plusargs("out=%s", out)) $fatal(1, "an argument is missing");
    repeat (4) @(negedge clk);
    reset = 0;
    for (frame = 1; frame <= FRAMES; frame++) begin
      {column, row, width, waited} = '0;
      while (!ready) @(negedge clk);
      file = $fopen($sformatf("%s/frame_%0d.txt", out, frame), "w");
      vsync = 1;
      @(negedge clk);
      vsync = 0;
      @(negedge clk);
      while (!ready) begin
        @(negedge clk);
        waited++;
        if (waited > 1000000) $fatal(1, "frame %0d does not end", frame);
      end
      $fclose(file);
      $display("frame %0d: %0d x %0d in %0d clocks", frame, width, row, waited);
    end
    $finish;
  end
endmodule
