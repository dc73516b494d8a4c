// The clocks of a frame of `galpix_stream`: two frames of a map that is never late and a receiver that is never slow.
// Galpixels move by up to REACH rows; every cell that comes out is counted, and the arrivals too.
`timescale 1ns / 1ps
module pace;
  parameter int COLUMN = 10, ROW = 10, BAND = 5, FRONT = 4, RICHEST = 5, COLUMNS = 1024, ROWS = 768, REACH = 8;
  localparam int RECORD = galpixel::RECORD;
  logic clk = 0, reset = 1, busy, tready, out_valid, out_last, out_user, misframed, beyond, edge_valid, edge_bit;
  logic tvalid = 0;
  logic [RECORD-1:0] given, out;
  logic [319:0] count;
  int column = 0, row = 0, taken = 0, came = 0, clocks = 0, frame = 0, speed;
  always #5 clk = !clk;

  // Every seventh row is fast downwards or upwards, the others are still.
  always_comb begin
    given = '0;
    speed = row % 14 == 0 ? REACH : row % 14 == 7 ? -REACH : 0;
    given = RECORD'(32'(speed <<< galpixel::Y_VF) & ((32'd1 << galpixel::VELOCITY_Y_BITS) - 1)) << galpixel::VELOCITY_Y_LSB;
  end
  galpix_stream #(
      .COLUMN(COLUMN), .ROW(ROW), .BAND(BAND), .FRONT(FRONT), .RICHEST(RICHEST), .ROUNDS(1)
  ) dut (
      .clk, .reset, .columns((COLUMN + 1)'(COLUMNS)), .rows((ROW + 1)'(ROWS)), .reach((ROW + 1)'(REACH)), .rounding(2'd3),
      .fill_mode(3'(RICHEST)), .rounds(5'd1), .edge_threshold(32'd1024), .frame(32'(frame)), .busy, .s_axis_tvalid(tvalid),
      .s_axis_tready(tready), .s_axis_tdata(given), .s_axis_tlast(column == COLUMNS - 1),
      .s_axis_tuser(row == 0 && column == 0), .m_axis_tvalid(out_valid), .m_axis_tready(1'b1), .m_axis_tdata(out),
      .m_axis_tlast(out_last), .m_axis_tuser(out_user), .misframed, .beyond, .count, .edge_valid, .edge_bit
  );
  always @(posedge clk) begin
    if (busy) clocks++;
    if (!reset && out_valid) came++;
    if (!reset && tvalid && tready) begin
      taken++;
      column <= column == COLUMNS - 1 ? 0 : column + 1;
      if (column == COLUMNS - 1) row <= row == ROWS - 1 ? 0 : row + 1;
    end
  end
  initial begin
    repeat (4) @(negedge clk);
    reset = 0;
    while (!dut.band_ready) @(negedge clk);
    for (frame = 0; frame < 2; frame++) begin
      {taken, came, clocks} = '0;
      tvalid = 1;
      @(negedge clk);
      while (taken < COLUMNS * ROWS) @(negedge clk);
      tvalid = 0;
      while (busy) @(negedge clk);
      $display("frame %0d: %0d clocks for %0d x %0d cells", frame, clocks, COLUMNS, ROWS);
      if (came != COLUMNS * ROWS || count[31:0] != COLUMNS * ROWS || misframed || beyond)
        $fatal(1, "%0d came, %0d moved, misframed %b, beyond %b", came, count[31:0], misframed, beyond);
      // One clock a cell, one more a row, and the rows that the last galpixel waits in.
      if (clocks > (COLUMNS + 1) * (ROWS + REACH + 6)) $fatal(1, "that is too many");
    end
    $finish;
  end
endmodule
