// Resolution against section 7 of the specification: of all arrivals at a cell the smallest by class, then depth,
// then source. All sequences of four sources in a map of two by two cells, from a reset on: each has an arrival or
// none, of any class but empty, any depth, any source, at any cell; so all collisions under way at once, and none of
// them.
module band_proof (
    input logic       clk,
    input logic       reset,
    input logic       source,
    input logic       arrives,
    input logic       to_row,
    input logic       to_column,
    input logic       on_edge,
    input logic [1:0] number,
    input logic [galpixel::RECORD-1:0] record
);
  localparam int RECORD = galpixel::RECORD;
  localparam int DEPTH = galpixel::DEPTH_BITS;
  logic ready, collided, valid;
  logic [1:0] state, winner, row;
  logic [RECORD-1:0] cell_record;
  logic [3:0] seen = '0;

  wire [1:0] class_of = record[galpixel::CLASS_LSB +: 2];
  wire [DEPTH-1:0] depth_of = record[galpixel::DEPTH_LSB +: DEPTH];
  wire takes = source && ready && seen < 4;
  wire arrival = takes && arrives && class_of != 2'd3;
  galpix_band #(.COLUMN(1), .ROW(1), .BAND(1), .SOURCE(2), .ORDERED(0)) dut (
      .clk, .reset, .enable(1'b1), .ready, .columns(2'd2), .rows(2'd2), .reach(2'd1), .source(takes), .arrives(arrival),
      .to_row, .to_column, .on_edge, .number, .record, .collided, .valid, .state, .cell_record, .winner, .row
  );

  // What each cell must hold.
  logic [3:0] taken = '0, edges;
  logic [4*RECORD-1:0] best;
  logic [7:0] from;
  logic [2:0] out = '0;
  wire [1:0] place = {to_row, to_column};
  wire [RECORD-1:0] other = best[place*RECORD +: RECORD];
  wire [1:0] other_class = other[galpixel::CLASS_LSB +: 2];
  wire [DEPTH-1:0] other_depth = other[galpixel::DEPTH_LSB +: DEPTH];
  wire [1:0] other_number = from[place*2 +: 2];
  wire smaller = class_of < other_class || (class_of == other_class && (depth_of < other_depth
      || (depth_of == other_depth && number < other_number)));
  always_ff @(posedge clk)
    if (reset) begin
      seen <= '0;
      taken <= '0;
      out <= '0;
    end else begin
      if (takes) seen <= seen + 1'b1;
      if (arrival && (!taken[place] || smaller)) begin
        taken[place] <= 1'b1;
        best[place*RECORD +: RECORD] <= record;
        from[place*2 +: 2] <= number;
        edges[place] <= on_edge;
      end
      if (valid) out <= out + 1'b1;
    end

  always_comb
    if (!reset && valid) begin
      assert (out < 4);
      assert ((state == 2'd0) == !taken[out[1:0]]);
      if (taken[out[1:0]]) begin
        assert (cell_record == best[out[1:0]*RECORD +: RECORD]);
        assert (winner == from[out[1:0]*2 +: 2]);
        assert (state == (edges[out[1:0]] ? 2'd1 : 2'd2));
      end
    end
endmodule
