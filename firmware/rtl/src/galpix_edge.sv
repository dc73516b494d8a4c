// The bit of the edge map of a cell (specification, section 8), three clocks after the cell and its neighbours.
module galpix_edge #(
    parameter int DEPTH = 16
) (
    input  logic             clk,
    input  logic             enable,
    input  logic [31:0]      threshold,
    input  logic [3:0]       has,              // a neighbour to the left, right, above, below
    input  logic [DEPTH+1:0] centre,           // class and depth
    input  logic [DEPTH+1:0] left,
    input  logic [DEPTH+1:0] right,
    input  logic [DEPTH+1:0] above,
    input  logic [DEPTH+1:0] below,
    output logic             on_edge
);
  localparam int LAPLACIAN = DEPTH + 3;
  localparam logic signed [LAPLACIAN-1:0] MOST = {1'b0, {(LAPLACIAN - 1) {1'b1}}};

  // Outside the map the cell stands for its neighbour.
  wire [DEPTH+1:0] l = has[3] ? left : centre;
  wire [DEPTH+1:0] r = has[2] ? right : centre;
  wire [DEPTH+1:0] u = has[1] ? above : centre;
  wire [DEPTH+1:0] d = has[0] ? below : centre;
  logic [DEPTH:0] row, column;
  logic [DEPTH-1:0] z;
  logic empty, empty_2;
  logic signed [LAPLACIAN-1:0] curvature, limit;

  always_ff @(posedge clk)
    if (enable) begin
      row <= {1'b0, l[DEPTH-1:0]} + {1'b0, r[DEPTH-1:0]};
      column <= {1'b0, u[DEPTH-1:0]} + {1'b0, d[DEPTH-1:0]};
      z <= centre[DEPTH-1:0];
      empty <= &centre[DEPTH+:2] || &l[DEPTH+:2] || &r[DEPTH+:2] || &u[DEPTH+:2] || &d[DEPTH+:2];
      curvature <= LAPLACIAN'({2'b0, row} + {2'b0, column} - {1'b0, z, 2'b0});
      empty_2 <= empty;
      // No Laplacian is beyond MOST.
      limit <= |threshold[31:LAPLACIAN-1] ? MOST : threshold[LAPLACIAN-1:0];
      on_edge <= empty_2 || curvature > limit || curvature < -limit;
    end
endmodule
