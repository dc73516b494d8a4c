// Scan-out: of a new map, as it leaves the stream, the cells within the margin, as 8 bits of red, green and blue each
// (specification, sections 6 and 9). AXI4-Stream video: tuser marks the first pixel, tlast the last one of a row.
module galpix_scan #(
    parameter int COLUMN = 7,
    parameter int ROW = 4
) (
    input  logic                        clk,
    input  logic                        reset,
    input  logic [COLUMN:0]             left,        // columns of the margin
    input  logic [COLUMN:0]             width,
    input  logic [ROW:0]                top,
    input  logic [ROW:0]                height,
    input  logic                        s_axis_tvalid,
    output logic                        s_axis_tready,
    input  logic [galpixel::RECORD-1:0] s_axis_tdata,
    input  logic                        s_axis_tlast,
    input  logic                        s_axis_tuser,
    output logic                        m_axis_tvalid,
    input  logic                        m_axis_tready,
    output logic [23:0]                 m_axis_tdata,
    output logic                        m_axis_tlast,
    output logic                        m_axis_tuser
);
  logic [COLUMN:0] column;
  logic [ROW:0] row;
  wire [COLUMN:0] at_column = s_axis_tuser ? '0 : column;
  wire [ROW:0] at_row = s_axis_tuser ? '0 : row;
  wire shown = at_column >= left && at_column - left < width && at_row >= top && at_row - top < height;
  wire take = s_axis_tvalid && s_axis_tready;
  assign s_axis_tready = !m_axis_tvalid || m_axis_tready;

  // A narrower channel is extended by its own high bits.
  wire [galpixel::COLOUR_BITS-1:0] colour = s_axis_tdata[galpixel::COLOUR_LSB +: galpixel::COLOUR_BITS];
  wire unused = &{1'b0, s_axis_tdata};
  logic [7:0] red, green, blue;
  if (galpixel::COLOUR_BITS == 24) begin : rgb888
    assign {red, green, blue} = colour;
  end else if (galpixel::COLOUR_BITS == 16) begin : rgb565
    assign red = {colour[15:11], colour[15:13]};
    assign green = {colour[10:5], colour[10:9]};
    assign blue = {colour[4:0], colour[4:2]};
  end else if (galpixel::COLOUR_BITS == 8) begin : gray8
    assign {red, green, blue} = {3{colour}};
  end else begin : gray4
    assign {red, green, blue} = {6{colour}};
  end

  always_ff @(posedge clk)
    if (reset) {m_axis_tvalid, column, row} <= '0;
    else begin
      if (take) begin
        column <= s_axis_tlast ? '0 : at_column + 1'b1;
        row <= s_axis_tlast ? at_row + 1'b1 : at_row;
        m_axis_tdata <= {red, green, blue};
        m_axis_tuser <= at_column == left && at_row == top;
        m_axis_tlast <= at_column - left + 1'b1 == width;
      end
      if (s_axis_tready) m_axis_tvalid <= take && shown;
    end
endmodule
