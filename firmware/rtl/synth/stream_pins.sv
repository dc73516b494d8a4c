// Few pins around the streaming engine, for place and route. The sizes are constants, as on a board.
module stream_pins #(
    parameter int COLUMN = 7,
    parameter int ROW = 6,
    parameter int BAND = 5,
    parameter int FRONT = 5,
    parameter int RICHEST = 5,
    parameter int ROUNDS = 1,
    parameter int COLUMNS = 128,
    parameter int ROWS = 64,
    parameter int REACH = 8
) (
    input  logic clk,
    input  logic reset,
    input  logic d,
    input  logic load,
    output logic q
);
  localparam int RECORD = galpixel::RECORD;
  logic [RECORD-1:0] given, tdata, shifted;
  logic tvalid, tready, tlast, tuser, out_valid, out_ready, load_1, busy, misframed, beyond, edge_valid, edge_bit, folded;
  logic [31:0] frame;
  logic [319:0] count;
  always_ff @(posedge clk) begin
    given <= {given[RECORD-2:0], d};
    {tvalid, tlast, tuser, out_ready} <= given[3:0];
    frame <= frame + 32'(busy);
    load_1 <= load;
    folded <= ^{tready, tlast, tuser, misframed, beyond, edge_valid, edge_bit, out_valid, count};
    shifted <= load_1 ? tdata : {shifted[RECORD-2:0], folded};
    q <= shifted[RECORD-1];
    if (reset) frame <= '0;
  end
  galpix_stream #(
      .COLUMN(COLUMN), .ROW(ROW), .BAND(BAND), .FRONT(FRONT), .RICHEST(RICHEST), .ROUNDS(ROUNDS), .COUNTERS(0)
  ) stream (
      .clk, .reset, .columns((COLUMN + 1)'(COLUMNS)), .rows((ROW + 1)'(ROWS)), .reach((ROW + 1)'(REACH)),
      .rounding(2'd3), .fill_mode(3'(RICHEST)), .rounds(5'(ROUNDS)), .edge_threshold(32'd1024), .frame, .busy,
      .s_axis_tvalid(tvalid), .s_axis_tready(tready), .s_axis_tdata(given), .s_axis_tlast(tlast), .s_axis_tuser(tuser),
      .m_axis_tvalid(out_valid), .m_axis_tready(out_ready), .m_axis_tdata(tdata), .m_axis_tlast(), .m_axis_tuser(),
      .misframed, .beyond, .count, .edge_valid, .edge_bit
  );
endmodule
