// Propagation's second half (specification, section 7): arrivals become cells of the new map. They are resolved in a
// band of rows that rotates: a row is given out, and its place is free again, as soon as no later source reaches it.
//
// One arrival a clock, in any order within the reach of the sources so far; one cell a clock comes out, in raster
// order.
//
//   clock 0   the place's class and depth are read        clock 2   the smaller wins
//   clock 1   and registered                              clock 3   and is written
//
// Three arrivals may be under way to the same place: clock 2 looks at those first. Whether a place is taken says the
// xor of two bits: one is written by arrivals, the other when the place is read out, so that nothing needs two write
// ports.
module galpix_band #(
    parameter int COLUMN = 7,                  // bits of a column
    parameter int ROW = 4,
    parameter int BAND = 4,                    // log2 of the rows of the band: all rows, or 2 reach + 2 at least
    parameter int SOURCE = 1,                  // bits of the source's number
    parameter bit ORDERED = 1                  // sources come in raster order, so that their numbers need no comparison
) (
    input  logic                        clk,
    input  logic                        reset,
    input  logic                        enable,
    output logic                        ready,       // the band is empty: after a reset it takes a clock for each place
    input  logic [COLUMN:0]             columns,
    input  logic [ROW:0]                rows,
    input  logic [ROW:0]                reach,       // the most rows by which a galpixel moves
    input  logic                        source,      // one more cell of the front map has been looked at ...
    input  logic                        arrives,     // ... and has an arrival here:
    input  logic [ROW-1:0]              to_row,
    input  logic [COLUMN-1:0]           to_column,
    input  logic                        on_edge,
    input  logic [SOURCE-1:0]           number,
    input  logic [galpixel::RECORD-1:0] record,
    output logic                        collided,
    output logic                        valid,       // a cell of the new map
    output logic [1:0]                  state,       // 0 hole, 1 won by a cell on an edge, 2 by another one
    output logic [galpixel::RECORD-1:0] cell_record,
    output logic [SOURCE-1:0]           winner,
    output logic [ROW:0]                row          // rows before this one are out
);
  localparam int RECORD = galpixel::RECORD;
  localparam int DEPTH = galpixel::DEPTH_BITS > 0 ? galpixel::DEPTH_BITS : 1;
  localparam int RANK = 2 + DEPTH + (ORDERED ? 0 : SOURCE);
  localparam int PLACE = BAND + COLUMN;

  // After a reset both bits of every place are made equal.
  logic [PLACE:0] wiped;
  wire wiping = !wiped[PLACE];
  assign ready = !wiping;
  always_ff @(posedge clk)
    if (reset) wiped <= '0;
    else if (wiping) wiped <= wiped + 1'b1;

  // Arrivals.
  wire [PLACE-1:0] to = {to_row[BAND-1:0], to_column};
  logic [2:1] arriving;
  logic [5:3] won;
  logic [PLACE-1:0] to_1, to_2, to_3, to_4;
  logic [RECORD-1:0] record_1, record_2, record_3;
  logic [SOURCE-1:0] number_1, number_2, number_3;
  logic edge_1, edge_2, edge_3, bit_b, bit_a, bit_a_2, bit_b_2, bit_b_3;
  logic [RANK-1:0] rank, rank_2, new_2, rank_3, rank_4, rank_5;
  logic [5:3] same;
  wire [DEPTH-1:0] depth_1 = galpixel::DEPTH_BITS > 0 ? record_1[galpixel::DEPTH_LSB +: DEPTH] : '0;
  wire under_way = |(same & won);
  wire [RANK-1:0] old = same[3] && won[3] ? rank_3 : same[4] && won[4] ? rank_4 : same[5] && won[5] ? rank_5 : rank_2;
  wire taken = under_way || bit_a_2 != bit_b_2;
  wire wins = arriving[2] && (!taken || new_2 < old);

  always_ff @(posedge clk)
    if (reset) {arriving, won, collided} <= '0;
    else if (enable) begin
      arriving <= {arriving[1], arrives};
      {to_1, to_2, to_3, to_4} <= {to, to_1, to_2, to_3};
      {record_1, record_2, record_3} <= {record, record_1, record_2};
      {number_1, number_2, number_3} <= {number, number_1, number_2};
      {edge_1, edge_2, edge_3} <= {on_edge, edge_1, edge_2};
      rank_2 <= rank;
      new_2 <= RANK'({record_1[galpixel::CLASS_LSB +: 2], depth_1, number_1} >> (ORDERED ? SOURCE : 0));
      bit_a_2 <= bit_a;
      {bit_b_2, bit_b_3} <= {bit_b, bit_b_2};
      same <= {to_1 == to_4, to_1 == to_3, to_1 == to_2};
      won <= {won[4:3], wins};
      {rank_3, rank_4, rank_5} <= {new_2, rank_3, rank_4};
      collided <= arriving[2] && taken;
    end

  // Sources. A row counts as looked at when its last arrival is written.
  logic [4:1] looked_at;
  logic [COLUMN-1:0] column_looked_at;
  logic [ROW:0] rows_looked_at;
  wire row_ends = looked_at[4] && {1'b0, column_looked_at} + 1'b1 == columns;

  // What is read out.
  logic [COLUMN-1:0] read_column;
  logic [ROW:0] read_row;
  logic reading, reading_1, out_a, out_b;
  logic [PLACE-1:0] read_1, read_2;
  logic [RECORD+SOURCE:0] stored;
  wire [PLACE-1:0] read_at = {read_row[BAND-1:0], read_column};
  wire complete = (ROW + 2)'(rows_looked_at) > (ROW + 2)'(read_row) + (ROW + 2)'(reach) || rows_looked_at == rows;
  wire last_column = {1'b0, read_column} + 1'b1 == columns;
  wire last = last_column && read_row + 1'b1 == rows;
  assign reading = complete && rows_looked_at != 0;

  always_ff @(posedge clk)
    if (reset) {looked_at, column_looked_at, rows_looked_at, read_column, read_row, reading_1} <= '0;
    else if (enable) begin
      looked_at <= {looked_at[3:1], source};
      if (looked_at[4]) column_looked_at <= row_ends ? '0 : column_looked_at + 1'b1;
      if (row_ends) rows_looked_at <= rows_looked_at + 1'b1;
      reading_1 <= reading;
      {read_1, read_2} <= {read_at, read_1};
      if (reading) begin
        read_column <= last_column ? '0 : read_column + 1'b1;
        if (last_column) read_row <= read_row + 1'b1;
        if (last) {rows_looked_at, read_row} <= '0;
      end
    end
  assign row = read_row;

  // What comes out a clock after the memories, and the bit that frees its place.
  logic out_a_2, out_b_2, won_on_edge;
  wire free = valid && out_a_2 != out_b_2;
  assign state = out_a_2 == out_b_2 ? 2'd0 : won_on_edge ? 2'd1 : 2'd2;
  always_ff @(posedge clk)
    if (reset) valid <= 1'b0;
    else if (enable) begin
      valid <= reading_1;
      {cell_record, winner, won_on_edge} <= stored;
      {out_a_2, out_b_2} <= {out_a, out_b};
    end

  wire write_a = wiping || (enable && won[3]);
  wire [PLACE-1:0] write_a_at = wiping ? wiped[PLACE-1:0] : to_3;
  wire new_a = !wiping && !bit_b_3;
  wire write_b = wiping || (enable && free);
  wire [PLACE-1:0] write_b_at = wiping ? wiped[PLACE-1:0] : read_2;
  wire new_b = !wiping && out_a_2;

  galpix_ram #(.BITS(RANK), .ADDRESS(PLACE)) ranks (
      .clk, .write(enable && won[3]), .write_at(to_3), .data(rank_3), .read(enable), .read_at(to), .q(rank)
  );
  galpix_ram #(.BITS(RECORD + SOURCE + 1), .ADDRESS(PLACE)) records (
      .clk, .write(enable && won[3]), .write_at(to_3), .data({record_3, number_3, edge_3}), .read(enable),
      .read_at(read_at), .q(stored)
  );
  galpix_ram #(.BITS(1), .ADDRESS(PLACE)) a_for_arrivals (
      .clk, .write(write_a), .write_at(write_a_at), .data(new_a), .read(enable), .read_at(to), .q(bit_a)
  );
  galpix_ram #(.BITS(1), .ADDRESS(PLACE)) b_for_arrivals (
      .clk, .write(write_b), .write_at(write_b_at), .data(new_b), .read(enable), .read_at(to), .q(bit_b)
  );
  galpix_ram #(.BITS(1), .ADDRESS(PLACE)) a_for_reading (
      .clk, .write(write_a), .write_at(write_a_at), .data(new_a), .read(enable), .read_at(read_at), .q(out_a)
  );
  galpix_ram #(.BITS(1), .ADDRESS(PLACE)) b_for_reading (
      .clk, .write(write_b), .write_at(write_b_at), .data(new_b), .read(enable), .read_at(read_at), .q(out_b)
  );
endmodule
