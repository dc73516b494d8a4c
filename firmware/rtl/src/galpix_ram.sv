// A memory with one write port and one read port. What is read is registered, and held while `read` is low. No user
// reads and writes one place in one clock and needs either word, so that it maps to block memory without further
// logic.
module galpix_ram #(
    parameter int BITS = 8,
    parameter int ADDRESS = 8
) (
    input  logic               clk,
    input  logic               write,
    input  logic [ADDRESS-1:0] write_at,
    input  logic [BITS-1:0]    data,
    input  logic               read,
    input  logic [ADDRESS-1:0] read_at,
    output logic [BITS-1:0]    q
);
  (* no_rw_check *) logic [BITS-1:0] memory[1 << ADDRESS];

  always_ff @(posedge clk) begin
    if (write) memory[write_at] <= data;
    if (read) q <= memory[read_at];
  end
endmodule
