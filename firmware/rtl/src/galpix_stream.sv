// One frame of a galpixmap (specification, section 11) as a stream: galpixels of the front map in raster order in,
// those of the new map out, one a clock. No map is stored, only the band of rows that galpixels move in.
//
//   front ─▶ edge map ─▶ step ─▶ band of rows, resolved ─▶ rounds of bullets ─▶ holes ─▶ new map
//      └────────────────── rows of the front map that holes may still ask for ───────┘
//
// Both sides are AXI4-Stream: tuser marks the first galpixel of a map, tlast the last one of each row. What comes out
// may be stopped at any time; the stages then stand still. The settings must hold while `busy`.
module galpix_stream #(
    parameter int COLUMN = 7,                  // bits of a column
    parameter int ROW = 4,
    parameter int BAND = 4,                    // log2 of the rows of the band: all rows, or 2 reach + 3 at least
    parameter int FRONT = 4,                   // log2 of the rows for holes: all rows, or reach + ROUNDS + 6 at least
    parameter int RICHEST = 5,                 // the richest fill mode that is built
    parameter int ROUNDS = 1,                  // rounds of bullets that are built
    parameter bit COUNTERS = 1
) (
    input  logic                        clk,
    input  logic                        reset,
    input  logic [COLUMN:0]             columns,
    input  logic [ROW:0]                rows,
    input  logic [ROW:0]                reach,
    input  logic [1:0]                  rounding,
    input  logic [2:0]                  fill_mode,
    input  logic [4:0]                  rounds,      // 1 to ROUNDS
    input  logic [31:0]                 edge_threshold,
    input  logic [31:0]                 frame,
    output logic                        busy,
    input  logic                        s_axis_tvalid,
    output logic                        s_axis_tready,
    input  logic [galpixel::RECORD-1:0] s_axis_tdata,
    input  logic                        s_axis_tlast,
    input  logic                        s_axis_tuser,
    output logic                        m_axis_tvalid,
    input  logic                        m_axis_tready,
    output logic [galpixel::RECORD-1:0] m_axis_tdata,
    output logic                        m_axis_tlast,
    output logic                        m_axis_tuser,
    output logic                        misframed,   // tuser or tlast came elsewhere than they must, since the reset
    output logic                        beyond,      // a galpixel moved by more rows than `reach`, since the reset
    output logic [319:0]                count,       // of section 11, the first lowest; whole when `busy` ends
    // the edge map as it is made
    output logic                        edge_valid,
    output logic                        edge_bit
);
  localparam int RECORD = galpixel::RECORD;
  localparam int DEPTH = galpixel::DEPTH_BITS > 0 ? galpixel::DEPTH_BITS : 1;
  localparam bit SURFACES = RICHEST >= 3;

  logic enable, band_ready, holes_done;

  // --- What comes in
  // ------------------------------------------------------------------------------------------------- A row may enter
  // if neither the band nor the rows for holes still need its place for an older one.
  logic [COLUMN-1:0] in_column;
  logic [ROW-1:0] in_row;
  logic taking, room, active;
  assign busy = active || m_axis_tvalid;
  logic [ROW:0] band_row;
  logic [ROW-1:0] hole_row;
  wire in_last_column = {1'b0, in_column} + 1'b1 == columns;
  wire in_last = in_last_column && {1'b0, in_row} + 1'b1 == rows;
  // Limits of a clock ago hold, for they only rise within a frame, and no row of the next one is near them.
  logic [ROW+1:0] band_limit, front_limit;
  logic all_fit_band, all_fit_front;
  wire band_room = all_fit_band || (ROW + 2)'(in_row) < band_limit;
  wire front_room = all_fit_front || (ROW + 2)'(in_row) < front_limit;
  always_ff @(posedge clk) begin
    all_fit_band <= rows <= (ROW + 1)'(1 << BAND);
    all_fit_front <= rows <= (ROW + 1)'(1 << FRONT);
    band_limit <= (ROW + 2)'(band_row) + ((ROW + 2)'(1 << BAND) - (ROW + 2)'(reach));
    front_limit <= (ROW + 2)'(hole_row) + (ROW + 2)'(1 << FRONT);
  end
  assign s_axis_tready = enable && taking && room && band_ready;
  wire take = s_axis_tvalid && s_axis_tready;

  logic take_1;
  logic [RECORD-1:0] in_1;
  always_ff @(posedge clk)
    if (reset) begin
      {in_column, in_row, take_1, misframed, room, active} <= '0;
      taking <= 1'b1;
    end else begin
      // A clock late, which is why a row more is asked for than is needed.
      room <= band_room && front_room && !(take && in_last_column);
      if (enable) begin
        take_1 <= take;
        in_1 <= s_axis_tdata;
      end
      if (take) begin
        active <= 1'b1;
        in_column <= in_last_column ? '0 : in_column + 1'b1;
        if (in_last_column) in_row <= in_last ? '0 : in_row + 1'b1;
        if (in_last) taking <= 1'b0;
        if (s_axis_tuser != (in_row == 0 && in_column == 0) || s_axis_tlast != in_last_column) misframed <= 1'b1;
      end
      if (enable && holes_done) begin
        taking <= 1'b1;
        active <= 1'b0;
      end
    end

  // --- The front map's rows for holes
  // --------------------------------------------------------------------------------
  logic ask;
  logic [ROW-1:0] ask_row;
  logic [COLUMN-1:0] ask_column;
  logic [RECORD-1:0] front_cell;
  if (RICHEST >= 4) begin : whole_front
    galpix_ram #(.BITS(RECORD), .ADDRESS(FRONT + COLUMN)) front (
        .clk, .write(take), .write_at({in_row[FRONT-1:0], in_column}), .data(s_axis_tdata), .read(ask),
        .read_at({ask_row[FRONT-1:0], ask_column}), .q(front_cell)
    );
  end else if (RICHEST >= 1) begin : shown_front
    localparam int KEPT = galpixel::COLOUR_BITS + 2;
    logic [KEPT-1:0] kept;
    galpix_ram #(.BITS(KEPT), .ADDRESS(FRONT + COLUMN)) front (
        .clk, .write(take), .write_at({in_row[FRONT-1:0], in_column}),
        .data({
          s_axis_tdata[galpixel::COLOUR_LSB +: galpixel::COLOUR_BITS], s_axis_tdata[galpixel::CLASS_LSB +: 2]
        }),
        .read(ask), .read_at({ask_row[FRONT-1:0], ask_column}), .q(kept)
    );
    always_comb begin
      front_cell = '0;
      front_cell[galpixel::CLASS_LSB +: 2] = kept[1:0];
      front_cell[galpixel::COLOUR_LSB +: galpixel::COLOUR_BITS] = kept[KEPT-1:2];
    end
  end else begin : no_front
    assign front_cell = '0;
    wire unused = &{1'b0, ask, ask_column};
  end
  assign hole_row = ask_row;

  // --- Edges, and the galpixel that makes its step
  // -------------------------------------------------------------------
  logic stepping;
  logic [RECORD-1:0] galpixel_now;
  logic [ROW-1:0] row_now;
  logic [COLUMN-1:0] column_now;
  logic edge_early, on_edge;                   // a clock before the step's result, and with it
  if (SURFACES) begin : edges
    // The window has class and depth alone; the galpixel waits beside it in two rows, or in more where a row is so
    // short that a place would be written as it is read.
    localparam int KEY = DEPTH + 2;
    logic [KEY-1:0] key, left, right, above, below, centre, a, b, c, d;
    logic [3:0] has;
    logic done, next;
    logic [ROW+COLUMN-1:0] next_at;
    logic [ROW-1:0] in_row_1;
    logic [COLUMN-1:0] in_column_1;
    function automatic logic [COLUMN:0] waiting_at(input logic [ROW-1:0] of_row, input logic [COLUMN-1:0] of_column);
      waiting_at = columns <= 2 ? (COLUMN + 1)'({of_row, of_column[0]}) : {of_row[0], of_column};
    endfunction
    assign key[DEPTH +: 2] = in_1[galpixel::CLASS_LSB +: 2];
    assign key[DEPTH-1:0] = galpixel::DEPTH_BITS > 0 ? in_1[galpixel::DEPTH_LSB +: DEPTH] : '0;
    always_ff @(posedge clk)
      if (enable) {in_row_1, in_column_1} <= {in_row, in_column};
    galpix_window #(.BITS(KEY), .COLUMN(COLUMN), .ROW(ROW)) keys (
        .clk, .reset, .enable, .columns, .rows, .valid(take_1), .item(key), .window(stepping), .column(column_now),
        .row(row_now), .has, .above_left(a), .above, .above_right(b), .beside_left(left), .centre, .beside_right(right),
        .below_left(c), .below, .below_right(d), .done, .next, .next_at
    );
    galpix_ram #(.BITS(RECORD), .ADDRESS(COLUMN + 1)) waiting (
        .clk, .write(enable && take_1), .write_at(waiting_at(in_row_1, in_column_1)), .data(in_1), .read(next),
        .read_at(waiting_at(next_at[COLUMN +: ROW], next_at[COLUMN-1:0])), .q(galpixel_now)
    );
    galpix_edge #(.DEPTH(DEPTH)) bend (
        .clk, .enable, .threshold(edge_threshold), .has, .centre, .left, .right, .above, .below, .on_edge(edge_early)
    );
    wire unused = &{1'b0, a, b, c, d, done};
  end else begin : no_edges
    logic [ROW-1:0] in_row_1;
    logic [COLUMN-1:0] in_column_1;
    always_ff @(posedge clk)
      if (reset) stepping <= 1'b0;
      else if (enable) begin
        {in_row_1, in_column_1} <= {in_row, in_column};
        {row_now, column_now, galpixel_now, stepping} <= {in_row_1, in_column_1, in_1, take_1};
      end
    assign edge_early = 1'b0;
    wire unused = &{1'b0, edge_threshold};
  end

  // --- Step
  // ----------------------------------------------------------------------------------------------------------
  localparam int X_DOWN = galpixel::X_VF + 1 > galpixel::X_P ? galpixel::X_VF + 1 - galpixel::X_P : 0;
  localparam int Y_DOWN = galpixel::Y_VF + 1 > galpixel::Y_P ? galpixel::Y_VF + 1 - galpixel::Y_P : 0;
  localparam int Z_DOWN = galpixel::Z_VF + 1 > galpixel::Z_P ? galpixel::Z_VF + 1 - galpixel::Z_P : 0;
  localparam int X_T = X_DOWN > 0 ? X_DOWN : 1;
  localparam int Y_T = Y_DOWN > 0 ? Y_DOWN : 1;
  localparam int Z_T = Z_DOWN > 0 ? Z_DOWN : 1;
  logic [X_T-1:0] x_threshold;
  logic [Y_T-1:0] y_threshold;
  logic [Z_T-1:0] z_threshold;
  wire unused_frame = &{1'b0, frame};
  galpix_threshold #(.DOWN(X_DOWN)) of_x (.clk, .rounding, .frame(frame[X_T-1:0]), .threshold(x_threshold));
  galpix_threshold #(.DOWN(Y_DOWN)) of_y (.clk, .rounding, .frame(frame[Y_T-1:0]), .threshold(y_threshold));
  galpix_threshold #(.DOWN(Z_DOWN)) of_z (.clk, .rounding, .frame(frame[Z_T-1:0]), .threshold(z_threshold));

  logic [RECORD-1:0] moved;
  logic signed [galpixel::X_CELLS-1:0] x_cells;
  logic signed [galpixel::Y_CELLS-1:0] y_cells;
  logic [2:0] saturated;
  // What comes out of a memory has no time left for an adder.
  logic [RECORD-1:0] given;
  logic given_there;
  logic [ROW-1:0] given_row;
  logic [COLUMN-1:0] given_column;
  always_ff @(posedge clk)
    if (reset) given_there <= 1'b0;
    else if (enable) begin
      {given_there, given, given_row, given_column} <= {stepping, galpixel_now, row_now, column_now};
      on_edge <= edge_early;
    end
  galpix_lane lane (
      .clk, .enable, .x_threshold, .y_threshold, .z_threshold, .given, .after(moved), .x_cells, .y_cells,
      .saturated
  );
  logic [2:0] stepped, empty;
  logic [ROW-1:0] row_1, row_2, row_3;
  logic [COLUMN-1:0] column_1, column_2, column_3;
  always_ff @(posedge clk)
    if (reset) stepped <= '0;
    else if (enable) begin
      stepped <= {stepped[1:0], given_there};
      empty <= {empty[1:0], given[galpixel::CLASS_LSB +: 2] == 2'd3};
      {row_1, row_2, row_3} <= {given_row, row_1, row_2};
      {column_1, column_2, column_3} <= {given_column, column_1, column_2};
    end
  assign edge_valid = enable && stepped[2];
  assign edge_bit = on_edge;

  // --- Where it arrives: the sum, then whether that is on the map
  // ----------------------------------------------------
  localparam int X_SUM = (COLUMN + 1 > galpixel::X_CELLS ? COLUMN + 1 : galpixel::X_CELLS) + 1;
  localparam int Y_SUM = (ROW + 1 > galpixel::Y_CELLS ? ROW + 1 : galpixel::Y_CELLS) + 1;
  localparam int Y_MOST = (ROW + 2 > galpixel::Y_CELLS + 1 ? ROW + 2 : galpixel::Y_CELLS + 1);
  logic signed [X_SUM-1:0] x_to;
  logic signed [Y_SUM-1:0] y_to;
  logic arriving, source_1, source_2, edge_1, edge_2, arrives, lost, too_far;
  logic [RECORD-1:0] moved_1, moved_2;
  logic [ROW-1:0] to_row;
  logic [COLUMN-1:0] to_column;
  logic [2:0] clamped;
  wire on_map = !x_to[X_SUM-1] && x_to < $signed(X_SUM'(columns)) && !y_to[Y_SUM-1] && y_to < $signed(Y_SUM'(rows));
  wire signed [Y_MOST-1:0] farthest = $signed(Y_MOST'(reach));
  always_ff @(posedge clk)
    if (reset) {arriving, source_1, source_2, arrives, lost, too_far, beyond} <= '0;
    else if (enable) begin
      x_to <= X_SUM'($signed({1'b0, column_3})) + X_SUM'(x_cells);
      y_to <= Y_SUM'($signed({1'b0, row_3})) + Y_SUM'(y_cells);
      arriving <= stepped[2] && !empty[2];
      source_1 <= stepped[2];
      edge_1 <= on_edge;
      moved_1 <= moved;
      clamped <= saturated;
      too_far <= stepped[2] && !empty[2] && (Y_MOST'(y_cells) > farthest || Y_MOST'(y_cells) < -farthest);
      source_2 <= source_1;
      edge_2 <= edge_1;
      moved_2 <= moved_1;
      arrives <= arriving && on_map;
      lost <= arriving && !on_map;
      to_row <= y_to[ROW-1:0];
      to_column <= x_to[COLUMN-1:0];
      if (too_far && arriving && on_map) beyond <= 1'b1;
    end

  // --- Resolution
  // ----------------------------------------------------------------------------------------------------
  logic collided, resolved, winner;
  logic [1:0] resolved_state;
  logic [RECORD-1:0] resolved_record;
  galpix_band #(.COLUMN(COLUMN), .ROW(ROW), .BAND(BAND)) band (
      .clk, .reset, .enable, .ready(band_ready), .columns, .rows, .reach, .source(source_2), .arrives, .to_row,
      .to_column, .on_edge(edge_2), .number(1'b0), .record(moved_2), .collided, .valid(resolved),
      .state(resolved_state), .cell_record(resolved_record), .winner, .row(band_row)
  );
  wire unused_winner = &{1'b0, winner};

  // --- Bullets and holes
  // ---------------------------------------------------------------------------------------------
  localparam int STAGES = SURFACES ? ROUNDS : 0;
  logic [STAGES:0] round_valid;
  logic [2*STAGES+1:0] round_state;
  logic [(STAGES+1)*RECORD-1:0] round_record;
  logic [STAGES:0] made;
  assign made[STAGES] = 1'b0;
  assign round_valid[0] = resolved;
  assign round_state[0*2 +: 2] = resolved_state;
  assign round_record[0*RECORD +: RECORD] = resolved_record;
  for (genvar k = 0; k < STAGES; k++) begin : round
    galpix_bullets #(.COLUMN(COLUMN), .ROW(ROW)) bullets (
        .clk, .reset, .enable, .columns, .rows, .active(fill_mode >= 3'd3 && 5'(k) < rounds),
        .final_round(5'(k) + 1'b1 == rounds), .valid(round_valid[k]), .state(round_state[k*2 +: 2]),
        .record(round_record[k*RECORD +: RECORD]), .made(made[k]), .out_valid(round_valid[k+1]),
        .out_state(round_state[(k+1)*2 +: 2]), .out_record(round_record[(k+1)*RECORD +: RECORD])
    );
  end
  if (STAGES == 0) begin : no_rounds
    wire unused = &{1'b0, rounds};
  end

  logic new_valid;
  logic [1:0] filled;
  logic [RECORD-1:0] new_record;
  galpix_holes #(.COLUMN(COLUMN), .ROW(ROW), .EXTEND(RICHEST >= 5), .GALDEBRIS(RICHEST >= 4)) holes (
      .clk, .reset, .enable, .columns, .rows, .fill_mode, .valid(round_valid[STAGES]), .state(round_state[STAGES*2 +: 2]),
      .record(round_record[STAGES*RECORD +: RECORD]), .ask, .ask_row, .ask_column, .front(front_cell), .out_valid(new_valid),
      .out_record(new_record), .filled, .done(holes_done)
  );

  // --- What goes out
  // ------------------------------------------------------------------------------------------------- Four places
  // take what is under way when the receiver stops: `enable` follows a clock later.
  logic [RECORD-1:0] waiting_out[4];
  logic [1:0] put_at, get_at;
  logic [2:0] waiting_count;
  logic [COLUMN-1:0] out_column;
  logic [ROW-1:0] out_row;
  wire put = enable && new_valid;
  wire get = m_axis_tvalid && m_axis_tready;
  wire out_last_column = {1'b0, out_column} + 1'b1 == columns;
  wire out_last_row = {1'b0, out_row} + 1'b1 == rows;
  assign m_axis_tvalid = waiting_count != 0;
  assign m_axis_tdata = waiting_out[get_at];
  assign m_axis_tuser = out_row == 0 && out_column == 0;
  assign m_axis_tlast = out_last_column;
  always_ff @(posedge clk) begin
    if (put) waiting_out[put_at] <= new_record;
    if (reset) begin
      {put_at, get_at, waiting_count, out_column, out_row} <= '0;
      enable <= 1'b1;
    end else begin
      enable <= waiting_count <= 3'd1;
      waiting_count <= waiting_count + 3'(put) - 3'(get);
      if (put) put_at <= put_at + 1'b1;
      if (get) begin
        get_at <= get_at + 1'b1;
        out_column <= out_last_column ? '0 : out_column + 1'b1;
        if (out_last_column) out_row <= out_last_row ? '0 : out_row + 1'b1;
      end
    end
  end

  // --- Counts
  // --------------------------------------------------------------------------------------------------------
  if (COUNTERS) begin : counters
    logic [4:0] bullets;
    always_comb begin
      bullets = '0;
      for (int k = 0; k <= STAGES; k++) bullets += 5'(made[k]);
    end
    wire hole = new_valid && filled != 2'd0;
    always_ff @(posedge clk)
      if (reset || (take && !active)) count <= '0;
      else if (enable) begin
        if (arriving) count[0*32 +: 32] <= count[0*32 +: 32] + 1'b1;
        if (lost) count[1*32 +: 32] <= count[1*32 +: 32] + 1'b1;
        if (collided) count[2*32 +: 32] <= count[2*32 +: 32] + 1'b1;
        if (arriving) count[3*32 +: 32] <= count[3*32 +: 32] + 32'(clamped);
        if (stepped[2] && on_edge && fill_mode >= 3'd3) count[4*32 +: 32] <= count[4*32 +: 32] + 1'b1;
        count[5*32 +: 32] <= count[5*32 +: 32] + 32'(bullets) + 32'(hole);
        count[6*32 +: 32] <= count[6*32 +: 32] + 32'(bullets);
        if (new_valid && filled == 2'd1) count[7*32 +: 32] <= count[7*32 +: 32] + 1'b1;
        if (new_valid && filled == 2'd2) count[8*32 +: 32] <= count[8*32 +: 32] + 1'b1;
        if (new_valid && filled == 2'd3) count[9*32 +: 32] <= count[9*32 +: 32] + 1'b1;
      end
  end else begin : uncounted
    assign count = '0;
    wire unused = &{1'b0, made, filled, lost, collided, clamped};
  end
endmodule
