// A galpixmap in memory, and its frames (specification, section 11): `start` makes the next one, in place. One clock
// a cell, and what the stream needs until its first and last cells are out.
//
// The host writes and reads the map while not `busy`. What the frame becomes is also given out as a stream, for a
// display (`galpix_scan`); it may be stopped, and the frame then waits.
module galpix_frame #(
    parameter int COLUMN = 7,
    parameter int ROW = 4,
    parameter int BAND = 4,
    parameter int FRONT = 4,
    parameter int RICHEST = 5,
    parameter int ROUNDS = 1,
    parameter bit COUNTERS = 1
) (
    input  logic                        clk,
    input  logic                        reset,
    input  logic [COLUMN:0]             columns,
    input  logic [ROW:0]                rows,
    input  logic [ROW:0]                reach,
    input  logic [1:0]                  rounding,
    input  logic [2:0]                  fill_mode,
    input  logic [4:0]                  rounds,
    input  logic [31:0]                 edge_threshold,
    input  logic [31:0]                 frame,
    input  logic                        start,
    output logic                        busy,
    input  logic                        host_write,
    input  logic                        host_read,
    input  logic [ROW+COLUMN-1:0]       host_at,         // row and column
    input  logic [galpixel::RECORD-1:0] host_data,
    output logic [galpixel::RECORD-1:0] host_q,          // a clock later
    output logic                        m_axis_tvalid,
    input  logic                        m_axis_tready,
    output logic [galpixel::RECORD-1:0] m_axis_tdata,
    output logic                        m_axis_tlast,
    output logic                        m_axis_tuser,
    output logic                        misframed,
    output logic                        beyond,
    output logic [319:0]                count,
    output logic                        edge_valid,
    output logic                        edge_bit
);
  localparam int RECORD = galpixel::RECORD;

  // The map is read ahead of the stream by one galpixel, and written behind it.
  logic reading, there, taken, streaming;
  logic [COLUMN-1:0] read_column, at_column, write_column;
  logic [ROW-1:0] read_row, at_row, write_row;
  logic [RECORD-1:0] q;
  wire next = reading && (!there || taken);
  wire read_last_column = {1'b0, read_column} + 1'b1 == columns;
  wire read_last_row = {1'b0, read_row} + 1'b1 == rows;
  wire at_last_column = {1'b0, at_column} + 1'b1 == columns;
  wire written = m_axis_tvalid && m_axis_tready;
  assign host_q = q;
  assign busy = reading || there || streaming;

  always_ff @(posedge clk)
    if (reset) {reading, there, read_column, read_row, write_column, write_row} <= '0;
    else begin
      if (start && !busy) reading <= 1'b1;
      if (next) begin
        {at_row, at_column} <= {read_row, read_column};
        read_column <= read_last_column ? '0 : read_column + 1'b1;
        if (read_last_column) read_row <= read_last_row ? '0 : read_row + 1'b1;
        if (read_last_column && read_last_row) reading <= 1'b0;
      end
      there <= next || (there && !taken);
      if (written) begin
        write_column <= m_axis_tlast ? '0 : write_column + 1'b1;
        if (m_axis_tlast) write_row <= {1'b0, write_row} + 1'b1 == rows ? '0 : write_row + 1'b1;
      end
    end

  galpix_ram #(.BITS(RECORD), .ADDRESS(ROW + COLUMN)) map (
      .clk, .write(written || (host_write && !busy)), .write_at(busy ? {write_row, write_column} : host_at),
      .data(busy ? m_axis_tdata : host_data), .read(next || (host_read && !busy)),
      .read_at(busy ? {read_row, read_column} : host_at), .q
  );

  galpix_stream #(
      .COLUMN(COLUMN), .ROW(ROW), .BAND(BAND), .FRONT(FRONT), .RICHEST(RICHEST), .ROUNDS(ROUNDS), .COUNTERS(COUNTERS)
  ) stream (
      .clk, .reset, .columns, .rows, .reach, .rounding, .fill_mode, .rounds, .edge_threshold, .frame, .busy(streaming),
      .s_axis_tvalid(there), .s_axis_tready(taken), .s_axis_tdata(q), .s_axis_tlast(at_last_column),
      .s_axis_tuser(at_row == 0 && at_column == 0), .m_axis_tvalid, .m_axis_tready, .m_axis_tdata, .m_axis_tlast,
      .m_axis_tuser, .misframed, .beyond, .count, .edge_valid, .edge_bit
  );
endmodule
