// One round of bullets (specification, section 10): a hole with neighbours inside a surface becomes their mean. Cells
// in raster order, one a clock; each comes out `columns` + 1 cells and seven clocks later.
module galpix_bullets #(
    parameter int COLUMN = 7,
    parameter int ROW = 4
) (
    input  logic                        clk,
    input  logic                        reset,
    input  logic                        enable,
    input  logic [COLUMN:0]             columns,
    input  logic [ROW:0]                rows,
    input  logic                        active,      // false: cells pass as they are
    input  logic                        final_round,
    input  logic                        valid,
    input  logic [1:0]                  state,
    input  logic [galpixel::RECORD-1:0] record,
    output logic                        made,        // a bullet, counted once
    output logic                        out_valid,
    output logic [1:0]                  out_state,   // 3: a bullet of the last round
    output logic [galpixel::RECORD-1:0] out_record
);
  localparam int RECORD = galpixel::RECORD;
  localparam int ITEM = RECORD + 2;
  localparam logic [1:0] HOLE = 2'd0, INSIDE = 2'd2, FRESH = 2'd3;
  localparam logic [RECORD-1:0] CLASS = RECORD'(2'd3) << galpixel::CLASS_LSB;
  localparam logic [RECORD-1:0] DEBRIS = RECORD'(2'd2) << galpixel::CLASS_LSB;

  logic window, done, next;
  logic [3:0] has;
  logic [COLUMN-1:0] column;
  logic [ROW-1:0] row;
  logic [ROW+COLUMN-1:0] next_at;
  logic [ITEM-1:0] upper_left, above, upper_right, left, centre, right, lower_left, below, lower_right;
  galpix_window #(.BITS(ITEM), .COLUMN(COLUMN), .ROW(ROW)) cells (
      .clk, .reset, .enable, .columns, .rows, .valid, .item({state, record}), .window, .column, .row, .has,
      .above_left(upper_left), .above, .above_right(upper_right), .beside_left(left), .centre, .beside_right(right),
      .below_left(lower_left), .below, .below_right(lower_right), .done, .next, .next_at
  );
  wire unused = &{1'b0, done, next, next_at, column, row};

  function automatic logic inside_surface(input logic neighbour, input logic [1:0] its_state);
    inside_surface = neighbour && its_state == INSIDE;
  endfunction
  function automatic logic vacant(input logic neighbour, input logic [1:0] its_state);
    vacant = !neighbour || its_state == HOLE;
  endfunction

  // Clock 1: which neighbours count, and where each of the four that are added comes from: 0 to 3 for a to d.
  wire [3:0] sides = {
    inside_surface(has[3], left[RECORD +: 2]),
    inside_surface(has[2], right[RECORD +: 2]),
    inside_surface(has[1], above[RECORD +: 2]),
    inside_surface(has[0], below[RECORD +: 2])
  };
  wire [3:0] corners = {
    inside_surface(has[3] && has[1], upper_left[RECORD +: 2]),
    inside_surface(has[2] && has[0], lower_right[RECORD +: 2]),
    inside_surface(has[2] && has[1], upper_right[RECORD +: 2]),
    inside_surface(has[3] && has[0], lower_left[RECORD +: 2])
  };
  wire all_vacant = vacant(has[3], left[RECORD +: 2]) && vacant(has[2], right[RECORD +: 2])
      && vacant(has[1], above[RECORD +: 2]) && vacant(has[0], below[RECORD +: 2]);
  wire diagonal = sides == 0 && all_vacant;
  logic diagonal_1;
  logic [4:1] there, bullet;
  logic [3:0] counts_1;                        // a, b, c, d
  logic [RECORD-1:0] left_1, upper_left_1, right_1, lower_right_1, above_1, upper_right_1, below_1, lower_left_1;
  logic [ITEM-1:0] centre_1, centre_2, centre_3, centre_4;

  always_ff @(posedge clk)
    if (enable) begin
      diagonal_1 <= diagonal;
      counts_1 <= diagonal ? corners : sides;
      left_1 <= left[RECORD-1:0];
      upper_left_1 <= upper_left[RECORD-1:0];
      right_1 <= right[RECORD-1:0];
      lower_right_1 <= lower_right[RECORD-1:0];
      above_1 <= above[RECORD-1:0];
      upper_right_1 <= upper_right[RECORD-1:0];
      below_1 <= below[RECORD-1:0];
      lower_left_1 <= lower_left[RECORD-1:0];
    end

  // Clock 2: the four, clocks 3 and 4: their mean.
  wire [RECORD-1:0] a = diagonal_1 ? upper_left_1 : left_1;
  wire [RECORD-1:0] b = diagonal_1 ? lower_right_1 : right_1;
  wire [RECORD-1:0] c = diagonal_1 ? upper_right_1 : above_1;
  wire [RECORD-1:0] d = diagonal_1 ? lower_left_1 : below_1;
  wire [RECORD-1:0] a_or_b = counts_1[3] ? a : b;
  wire [RECORD-1:0] c_or_d = counts_1[1] ? c : d;
  logic [RECORD-1:0] p, q, r, s, mean;
  always_ff @(posedge clk)
    if (enable) begin
      if (&counts_1) {p, q, r, s} <= {a, b, c, d};
      else if (&counts_1[3:2]) {p, q, r, s} <= {a, b, a, b};
      else if (&counts_1[1:0]) {p, q, r, s} <= {c, d, c, d};
      else if (counts_1[3:2] == 0) {p, q, r, s} <= {4{c_or_d}};
      else if (counts_1[1:0] == 0) {p, q, r, s} <= {4{a_or_b}};
      else {p, q, r, s} <= {2{a_or_b, c_or_d}};
    end
  galpix_mean of_four (.clk, .enable, .p, .q, .r, .s, .mean);

  always_ff @(posedge clk)
    if (reset) there <= '0;
    else if (enable) begin
      there <= {there[3:1], window};
      bullet <= {bullet[3:2], bullet[1] && counts_1 != 0, active && centre[RECORD +: 2] == HOLE};
      {centre_1, centre_2, centre_3, centre_4} <= {centre, centre_1, centre_2, centre_3};
    end

  assign made = there[4] && bullet[4];
  assign out_valid = there[4];
  assign out_state = !bullet[4] ? centre_4[RECORD +: 2] : final_round ? FRESH : INSIDE;
  assign out_record = bullet[4] ? (mean & ~CLASS) | DEBRIS : centre_4[RECORD-1:0];
endmodule
