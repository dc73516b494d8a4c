// The holes of one `fill` case: rounds of `galpix_bullets`, then `galpix_holes`.
`timescale 1ns / 1ps
module fill;
  parameter int COLUMN = 7, ROW = 4, ROUNDS = 16;
  localparam int RECORD = galpixel::RECORD, WORDS = galpixel::WORDS, MOST = 1 << (COLUMN + ROW);

  logic clk = 0, reset = 1, valid = 0, ask, out_valid, done;
  logic [31:0] columns, rows, fill_mode, rounds, counts[0:9];
  logic [31:0] words[0:MOST*WORDS-1], resolved[0:MOST*WORDS-1], map[0:MOST*WORDS-1];
  logic [31:0] winners[0:MOST-1], edges[0:MOST/32-1];
  logic [RECORD-1:0] front, out_record, record = '0;
  logic [1:0] state = '0, filled;
  logic [ROW-1:0] ask_row;
  logic [COLUMN-1:0] ask_column;
  logic [ROUNDS:0] round_valid;
  logic [2*ROUNDS+1:0] round_state;
  logic [(ROUNDS+1)*RECORD-1:0] round_record;
  logic [ROUNDS-1:0] made;
  string folder;
  int cells, n, k, at, right, wrong, holes, bullets, debris, galdebris, empty, clocks;
  always #5 clk = !clk;
  assign round_valid[0] = valid;
  assign round_state[1:0] = state;
  assign round_record[RECORD-1:0] = record;

  genvar k_of;
  for (k_of = 0; k_of < ROUNDS; k_of++) begin : rounds_of
    galpix_bullets #(.COLUMN(COLUMN), .ROW(ROW)) dut (
        .clk, .reset, .enable(1'b1), .columns(columns[COLUMN:0]), .rows(rows[ROW:0]),
        .active(fill_mode >= 3 && k_of < rounds), .final_round(k_of + 1 == rounds), .valid(round_valid[k_of]),
        .state(round_state[k_of*2 +: 2]), .record(round_record[k_of*RECORD +: RECORD]), .made(made[k_of]),
        .out_valid(round_valid[k_of+1]), .out_state(round_state[(k_of+1)*2 +: 2]),
        .out_record(round_record[(k_of+1)*RECORD +: RECORD])
    );
  end
  galpix_holes #(.COLUMN(COLUMN), .ROW(ROW)) dut (
      .clk, .reset, .enable(1'b1), .columns(columns[COLUMN:0]), .rows(rows[ROW:0]), .fill_mode(fill_mode[2:0]),
      .valid(round_valid[ROUNDS]), .state(round_state[ROUNDS*2 +: 2]), .record(round_record[ROUNDS*RECORD +: RECORD]), .ask,
      .ask_row, .ask_column, .front, .out_valid, .out_record, .filled, .done
  );
  always @(posedge clk)
    if (ask) for (k = 0; k < WORDS; k++) front[32*(WORDS-1-k) +: 32] <= words[k*cells + ask_row*columns + ask_column];

  always @(negedge clk)
    if (!reset) begin
      for (int index = 0; index < ROUNDS; index++) if (made[index]) begin
        bullets++;
        holes++;
      end
      if (out_valid) begin
        for (int word = 0; word < WORDS; word++)
          if (out_record[32*(WORDS-1-word) +: 32] === map[word*cells + at]) right++;
          else begin
            wrong++;
            if (wrong < 5) $display("cell %0d, word %0d: %h, not %h", at, word, out_record[32*(WORDS-1-word) +: 32], map[word*cells + at]);
          end
        holes += 32'(filled != 0);
        debris += 32'(filled == 1);
        galdebris += 32'(filled == 2);
        empty += 32'(filled == 3);
        at++;
      end
    end

  initial begin
    if (!($value$plusargs("folder=%s", folder) && $value$plusargs("columns=%d", columns)
          && $value$plusargs("rows=%d", rows) && $value$plusargs("fill_mode=%d", fill_mode)
          && $value$plusargs("rounds=%d", rounds))) $fatal(1, "an argument is missing");
    cells = columns * rows;
    {at, right, wrong, holes, bullets, debris, galdebris, empty, clocks} = '0;
    $readmemh({folder, "/front.hex"}, words, 0, WORDS * cells - 1);
    $readmemh({folder, "/resolved.hex"}, resolved, 0, WORDS * cells - 1);
    $readmemh({folder, "/winners.hex"}, winners, 0, cells - 1);
    $readmemh({folder, "/edges.hex"}, edges, 0, (cells + 31) / 32 - 1);
    $readmemh({folder, "/map.hex"}, map, 0, WORDS * cells - 1);
    $readmemh({folder, "/counts.hex"}, counts, 0, 9);
    repeat (4) @(negedge clk);
    reset = 0;
    for (n = 0; n < cells; n++) begin
      while ($urandom_range(4) == 0) @(negedge clk);
      valid = 1;
      state = winners[n] == 32'hffffffff ? 2'd0 : edges[winners[n]/32][winners[n]%32] ? 2'd1 : 2'd2;
      for (k = 0; k < WORDS; k++) record[32*(WORDS-1-k) +: 32] = resolved[k*cells + n];
      @(negedge clk);
      valid = 0;
    end
    while (!done && clocks < 100 * cells + 10000) begin
      @(negedge clk);
      clocks++;
    end
    @(negedge clk);
    if (at != cells || holes != counts[5] || bullets != counts[6] || debris != counts[7] || galdebris != counts[8]
        || empty != counts[9]) begin
      wrong++;
      $display("%0d cells; holes %0d, bullets %0d, debris %0d, galdebris %0d, empty %0d", at, holes, bullets, debris, galdebris, empty);
    end else right += 6;
    $display("RESULT %0d %0d", right, wrong);
    $finish;
  end
endmodule
