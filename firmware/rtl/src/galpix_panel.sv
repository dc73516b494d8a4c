// From a camera to a panel: after the reset the test pattern is loaded; each `vsync` then makes the next frame, which
// goes to the panel as it is made. Extend, one round of bullets, searched thresholds.
module galpix_panel #(
    parameter int COLUMN = 6,
    parameter int ROW = 6,
    parameter int BAND = 6,
    parameter int FRONT = 6,
    parameter int COLUMNS = 64,                // of the map, with the margin
    parameter int ROWS = 48,
    parameter int X_MARGIN = 2,                // columns left and right that are not shown
    parameter int Y_MARGIN = 1,
    parameter int EDGE_THRESHOLD = 1024
) (
    input  logic        clk,
    input  logic        reset,
    input  logic        vsync,                 // for a clock
    output logic        ready,                 // for the next frame
    output logic        m_axis_tvalid,
    input  logic        m_axis_tready,
    output logic [23:0] m_axis_tdata,
    output logic        m_axis_tlast,
    output logic        m_axis_tuser
);
  localparam int RECORD = galpixel::RECORD;
  localparam logic [ROW:0] REACH = galpixel::Y_REACH < ROWS ? (ROW + 1)'(galpixel::Y_REACH) : (ROW + 1)'(ROWS);

  logic loaded, start, busy, last, tvalid, tready, tlast, tuser, misframed, beyond, edge_valid, edge_bit;
  logic [ROW+COLUMN-1:0] at;
  logic [RECORD-1:0] pattern, tdata, host_q;
  logic [31:0] frame;
  logic [319:0] count;
  logic was_busy;
  assign start = vsync && loaded && !busy;
  assign ready = loaded && !busy && !m_axis_tvalid;
  always_ff @(posedge clk)
    if (reset) {loaded, frame, was_busy} <= '0;
    else begin
      was_busy <= busy;
      if (last) loaded <= 1'b1;
      // The counter is that of the map which the frame is made of, until its last galpixel is out.
      if (loaded && was_busy && !busy) frame <= frame + 1'b1;
    end

  galpix_pattern #(.COLUMN(COLUMN), .ROW(ROW)) camera (
      .clk, .reset, .columns((COLUMN + 1)'(COLUMNS)), .rows((ROW + 1)'(ROWS)), .next(!loaded), .at,
      .galpixel_there(pattern), .last
  );
  galpix_frame #(
      .COLUMN(COLUMN), .ROW(ROW), .BAND(BAND), .FRONT(FRONT), .RICHEST(5), .ROUNDS(1), .COUNTERS(0)
  ) frames (
      .clk, .reset, .columns((COLUMN + 1)'(COLUMNS)), .rows((ROW + 1)'(ROWS)), .reach(REACH), .rounding(2'd3),
      .fill_mode(3'd5), .rounds(5'd1), .edge_threshold(EDGE_THRESHOLD), .frame, .start, .busy, .host_write(!loaded),
      .host_read(1'b0), .host_at(at), .host_data(pattern), .host_q, .m_axis_tvalid(tvalid), .m_axis_tready(tready),
      .m_axis_tdata(tdata), .m_axis_tlast(tlast), .m_axis_tuser(tuser), .misframed, .beyond, .count, .edge_valid,
      .edge_bit
  );
  galpix_scan #(.COLUMN(COLUMN), .ROW(ROW)) scan (
      .clk, .reset, .left((COLUMN + 1)'(X_MARGIN)), .width((COLUMN + 1)'(COLUMNS - 2 * X_MARGIN)),
      .top((ROW + 1)'(Y_MARGIN)), .height((ROW + 1)'(ROWS - 2 * Y_MARGIN)), .s_axis_tvalid(tvalid),
      .s_axis_tready(tready), .s_axis_tdata(tdata), .s_axis_tlast(tlast), .s_axis_tuser(tuser), .m_axis_tvalid,
      .m_axis_tready, .m_axis_tdata, .m_axis_tlast, .m_axis_tuser
  );
  wire unused = &{1'b0, host_q, misframed, beyond, count, edge_valid, edge_bit};
endmodule
