// The mean of one field, in its place of a record that is 0 elsewhere; an absent field has BITS = 0.
module galpix_mean_field #(
    parameter int BITS = 8,
    parameter int LSB = 0,
    parameter bit SIGNED = 0
) (
    input  logic                        clk,
    input  logic                        enable,
    input  logic [galpixel::RECORD-1:0] p,
    input  logic [galpixel::RECORD-1:0] q,
    input  logic [galpixel::RECORD-1:0] r,
    input  logic [galpixel::RECORD-1:0] s,
    output logic [galpixel::RECORD-1:0] result,
    output logic [galpixel::RECORD-1:0] mask
);
  localparam int RECORD = galpixel::RECORD;
  if (BITS == 0) begin : absent
    assign {result, mask} = '0;
    wire unused = &{1'b0, clk, enable, p, q, r, s};
  end else begin : present
    logic [BITS:0] pq, rs;
    logic [BITS+1:0] sum;
    // The two that are added differ in how they are extended by two bits.
    always_ff @(posedge clk)
      if (enable) begin
        pq <= {SIGNED && p[LSB+BITS-1], p[LSB +: BITS]} + {SIGNED && q[LSB+BITS-1], q[LSB +: BITS]};
        rs <= {SIGNED && r[LSB+BITS-1], r[LSB +: BITS]} + {SIGNED && s[LSB+BITS-1], s[LSB +: BITS]};
        sum <= {SIGNED && pq[BITS], pq} + {SIGNED && rs[BITS], rs} + (BITS + 2)'(2);
      end
    wire unused = &{1'b0, sum[1:0], p, q, r, s};
    assign result = RECORD'(sum[BITS+1:2]) << LSB;
    assign mask = RECORD'({BITS {1'b1}}) << LSB;
  end
endmodule
