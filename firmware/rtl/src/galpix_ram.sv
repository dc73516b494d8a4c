// A memory with one write port and one read port. What is read is registered, and held while `read` is low. No user
// reads and writes one place in one clock and needs either word, so that it maps to block memory without further logic.
//
// It is cut into slices as wide as a block of 18 kbit is at this depth: then no word is put together from several
// blocks behind their outputs, which are the slowest there are.
module galpix_ram #(
    parameter int BITS = 8,
    parameter int ADDRESS = 8,
    parameter int SLICE =
        ADDRESS <= 9 ? 36 : ADDRESS == 10 ? 18 : ADDRESS == 11 ? 9 : ADDRESS == 12 ? 4 : ADDRESS == 13 ? 2 : 1
) (
    input  logic               clk,
    input  logic               write,
    input  logic [ADDRESS-1:0] write_at,
    input  logic [BITS-1:0]    data,
    input  logic               read,
    input  logic [ADDRESS-1:0] read_at,
    output logic [BITS-1:0]    q
);
  genvar at;
  for (at = 0; at < BITS; at = at + SLICE) begin : slice
    localparam int WIDTH = BITS - at < SLICE ? BITS - at : SLICE;
    (* no_rw_check *) logic [WIDTH-1:0] memory[1 << ADDRESS];
    logic [WIDTH-1:0] word;

    always_ff @(posedge clk) begin
      if (write) memory[write_at] <= data[at +: WIDTH];
      if (read) word <= memory[read_at];
    end
    assign q[at +: WIDTH] = word;
  end
endmodule
