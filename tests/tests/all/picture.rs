//! Small maps, drawn as text before and after: what each stage does to them. For the signs see `galpix_tests::art`.

use galpix_core::stages::{mark, on_edge, threshold_for_depth, words};
use galpix_core::{Class, FillMode, Galpixel, Margin, Settings, Tally};
use galpix_tests::art::{Art, Drawing, Panel, format, with_drawing};
use galpix_tests::memory::{Shape, with_controller, with_maps};
use galpix_tests::stage::number;

use Panel::{Class as Classes, Colour, Depth, Motion, Shown};

fn with_fill_mode(fill_mode: FillMode) -> Settings {
    Settings { fill_mode, ..Settings::for_depth(20) }
}

/// Draws `before`, makes a frame for each of `after` and compares.
fn frames(fill_mode: FillMode, panels: &[Panel], before: &[&str], after: &[&[&str]]) -> Tally {
    with_drawing(before, |controller| {
        let mut tally = Tally::default();
        for (number, expected) in (1..).zip(after) {
            tally = controller.step(&with_fill_mode(fill_mode));
            Art::of(controller.front(), panels).assert(&format!("{fill_mode:?}, frame {number}"), expected);
        }
        tally
    })
}

#[test]
fn of_two_galpixels_in_one_cell_the_nearer_wins() {
    let tally = frames(FillMode::None, &[Colour, Depth], &["A.B..  5.3..  >.<.."], &[&[".B...  .3..."]]);
    assert_eq!((tally.moved, tally.collided, tally.holes), (2, 1, 4));
    frames(FillMode::None, &[Colour, Depth], &["A.B..  2.3..  >.<.."], &[&[".A...  .2..."]]);
    frames(FillMode::None, &[Colour, Depth], &["A  3  v", ".  .  .", "B  5  ^"], &[&[".  .", "A  3", ".  ."]]);
}

#[test]
fn debris_loses_against_a_galpixel_however_near_it_is() {
    frames(FillMode::None, &[Colour, Depth], &["A.b  f.0  >.<"], &[&[".A.  .f."]]);
    frames(FillMode::None, &[Colour, Depth], &["a.B  0.f  >.<"], &[&[".B.  .f."]]);
    frames(FillMode::None, &[Colour, Depth], &["a.b  3.2  >.<"], &[&[".b.  .2."]]);
}

#[test]
fn a_tie_goes_to_the_smaller_source() {
    frames(FillMode::None, &[Colour], &["A.B  4.4  >.<"], &[&[".A."]]);
    frames(FillMode::None, &[Colour], &["A  4  v", ".  .  .", "B  4  ^"], &[&[".", "A", "."]]);
    // From above, from the left, and staying.
    frames(FillMode::None, &[Colour], &["..B  ..4  ..v", ".AC  .44  .>-"], &[&["...", "..B"]]);
}

#[test]
fn what_leaves_over_the_border_is_lost() {
    let tally = frames(
        FillMode::None,
        &[Colour],
        &["ABC  444  <^>", "D.E  4.4  <.>", "FGH  444  <v>"],
        &[&["...", "...", "..."]],
    );
    assert_eq!((tally.moved, tally.lost, tally.empty), (8, 8, 9));
}

#[test]
fn what_waits_in_the_margin_comes_in() {
    let drawing = Drawing(&["AB.....  44.....  }}.....", "..C...D  ..4...4  ..<...<"]);
    let shape = Shape { width: 3, height: 1, margin: Margin { left: 2, right: 2, top: 0, bottom: 1 } };
    with_controller(shape, format(), None, |controller| {
        drawing.store(controller.front_mut(), |_| ());
        let shown = |front: &_, expected| {
            let row: String = galpix_core::scan_out::row(front, 0)
                .map(|colour| char::from_u32(if colour == 0 { 0x2e } else { 0x40 + (colour & 255) / 8 }).unwrap())
                .collect();
            assert_eq!(row, expected, "on the display");
        };
        shown(controller.front(), "...");
        for (picture, display) in [
            (["..AB...", ".C...D."], "AB."),
            (["....AB.", "C...D.."], "..A"),
            // B has left over the border, A is in the margin.
            (["......A", "...D..."], "..."),
        ] {
            controller.step(&with_fill_mode(FillMode::None));
            Art::of(controller.front(), &[Colour]).assert("in the margin and out of them", &picture);
            shown(controller.front(), display);
        }
    });
}

/// A surface that is magnified: galpixels move away from the middle and leave gaps inside it.
#[test]
fn bullet_holes_of_a_zoom_are_filled_with_the_mean_of_their_neighbours() {
    // The hole opens between still galpixels and such that move by a cell; neighbours facing each other are averaged.
    let before = &["AACC..  4444..  -->>..", "AACC..  4444..  -->>..", "AACC..  4444..  -->>.."];
    let after: &[&str] = &["AAbCC.  44444.  --)>>.", "AAbCC.  44444.  --)>>.", "AAbCC.  44444.  --)>>."];
    let before_edges_matter = frames(FillMode::None, &[Colour], before, &[&["AA.CC.", "AA.CC.", "AA.CC."]]);
    assert_eq!(before_edges_matter.bullets, 0);
    // The last column of C is next to a hole, and so on an edge; A and the first C are inside.
    let tally = frames(FillMode::Bullet, &[Colour, Depth, Motion], before, &[after]);
    assert_eq!((tally.bullets, tally.holes, tally.empty), (3, 6, 3));
}

/// All holes of a round are decided at once, from what was there before it.
#[test]
fn a_crack_is_closed_from_both_sides_round_by_round() {
    let crack = &["AAACCC..  444444..  ---}}}.."];
    let tally = frames(FillMode::Bullet, &[Colour, Motion], crack, &[&["AAAacCCC  ----}}}}"]]);
    assert_eq!((tally.bullets, tally.holes), (2, 2));
    let wide = &["..AAACCC..  ..444444..  ..{{{}}}.."];
    for (reach, expected) in
        [(1, "AAAaaccCCC  ###~!!~###"), (2, "AAAaaccCCC  ###~~~~###"), (16, "AAAaaccCCC  ###~~~~###")]
    {
        with_drawing(wide, |controller| {
            controller.step(&Settings { reach, ..with_fill_mode(FillMode::Bullet) });
            Art::of(controller.front(), &[Colour, Classes]).assert(&format!("{reach} rounds"), &[expected]);
        });
    }
}

/// Columns and rows move apart in a zoom by 3/2: every hole of it is filled.
#[test]
fn no_hole_is_left_inside_of_a_surface_that_is_magnified() {
    let side = 12;
    let shape = Shape { width: 20, height: 20, margin: Margin::all(0) };
    with_controller(shape, format(), None, |controller| {
        for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
            let velocity = [number(f64::from(x) / 2.0), number(f64::from(y) / 2.0), number(0.0)];
            let galpixel = Galpixel { colour: [80; 3], depth: number(0.5), velocity, ..Galpixel::default() };
            controller.front_mut().store(x, y, &galpixel);
        }
        let tally = controller.step(&with_fill_mode(FillMode::Bullet));
        assert!(tally.bullets > 100, "{tally:?}");
        let covered = 15;
        for (x, y) in (0..covered).flat_map(|y| (0..covered).map(move |x| (x, y))) {
            let galpixel = controller.front().load(x, y).unwrap();
            assert!(
                matches!(galpixel.class, Class::Galpixel | Class::Debris),
                "a hole at {x}, {y}\n{:?}",
                Art::of(controller.front(), &[Colour])
            );
            assert_eq!((galpixel.colour, galpixel.depth), ([80; 3], number(0.5)), "{x}, {y}");
        }
    });
}

/// The paper's argument: the neighbours of a just-unobscured square are on edges, so that none of it is a bullet hole.
#[test]
fn a_just_unobscured_square_is_debris_from_its_corner_inwards() {
    // A near square B leaves over a far surface A; behind it nothing is known.
    let before = &[
        "AAAAAAAA  cccccccc  --------",
        "AAAAAAAA  cccccccc  --------",
        "AABBBAAA  cc444ccc  --}}}---",
        "AABBBAAA  cc444ccc  --}}}---",
        "AABBBAAA  cc444ccc  --}}}---",
        "AAAAAAAA  cccccccc  --------",
        "AAAAAAAA  cccccccc  --------",
    ];
    let after = &[
        "AAAAAAAA  ########  AAAAAAAA",
        "AAAAAAAA  ########  AAAAAAAA",
        "AAbbBBBA  ##!!####  AABBBBBA",
        "AAbbBBBA  ##!!####  AABBBBBA",
        "AAbbBBBA  ##!!####  AABBBBBA",
        "AAAAAAAA  ########  AAAAAAAA",
        "AAAAAAAA  ########  AAAAAAAA",
    ];
    for fill_mode in [FillMode::Bullet, FillMode::Galdebris] {
        let tally = frames(fill_mode, &[Colour, Classes, Shown], before, &[after]);
        assert_eq!((tally.bullets, tally.filled(), tally.collided), (0, 6, 6), "{fill_mode:?}");
        // More rounds of bullet filling do not eat into it.
        with_drawing(before, |controller| {
            controller.step(&Settings { reach: 16, ..with_fill_mode(fill_mode) });
            Art::of(controller.front(), &[Colour, Classes, Shown]).assert("16 rounds", after);
        });
    }
}

#[test]
fn galdebris_is_one_frame_late_and_then_two() {
    let before = &["CCAB.....  cc33.....  -->>....."];
    let after: &[&[&str]] = &[
        &["CCaAB....  ##!##....  -->>>...."],
        // The debris of the first frame moved on by one, and what it left is one later still.
        &["CCaaAB...  ##!~##...  -->>>>..."],
        &["CCaaaAB..  ##!~~##..  -->>>>>.."],
    ];
    let tally = frames(FillMode::Galdebris, &[Colour, Classes, Motion], before, after);
    assert_eq!((tally.galdebris, tally.moved, tally.collided), (1, 6, 0));
}

#[test]
fn extend_continues_the_farther_of_the_two_surfaces_beside_along_the_row() {
    // B leaves A, on either side; what lies behind B is A.
    let after: &[&[&str]] = &[&["AAaaBBB.  ##!!###.  cccc333.  ----}}}."], &["AAaaaaBB  ##~~!!##  cccccc33  ------}}"]];
    let tally = frames(FillMode::Extend, &[Colour, Classes, Depth, Motion], &["AABBB...  cc333...  --}}}..."], after);
    assert_eq!((tally.galdebris, tally.debris, tally.bullets), (2, 0, 0));
    let mirrored: &[&[&str]] = &[&[".BBBaaAA  .333cccc  .{{{----"]];
    frames(FillMode::Extend, &[Colour, Depth, Motion], &["...BBBAA  ...333cc  ...{{{--"], mirrored);
    // B leaves over the border; of C and A the farther is A, and of two as far the one on the left.
    frames(FillMode::Extend, &[Colour, Depth], &["CCBBAA  8833cc  --^^--"], &[&["CCaaAA  88cccc"]]);
    frames(FillMode::Extend, &[Colour, Depth], &["AABBCC  cc3388  --^^--"], &[&["AAaaCC  cccc88"]]);
    frames(FillMode::Extend, &[Colour, Depth], &["CCBBAA  cc33cc  --^^--"], &[&["CCccAA  cccccc"]]);
}

#[test]
fn what_extend_continued_moves_on_with_its_surface() {
    let before = &["AAABB....  ccc33....  >>>}}...."];
    let after: &[&[&str]] = &[&["aAAAaBB..  ~###!##..  >>>>>}}.."], &["aaAAAaaBB  ~~###~!##  >>>>>>>}}"]];
    frames(FillMode::Extend, &[Colour, Classes, Motion], before, after);
}

#[test]
fn extend_is_galdebris_where_a_whole_row_was_unobscured() {
    for fill_mode in [FillMode::Galdebris, FillMode::Extend] {
        let tally = frames(
            fill_mode,
            &[Colour, Classes, Depth, Motion],
            &["BB  33  vv", "..  ..  .."],
            &[&["bb  !!  33  vv", "BB  ##  33  vv"]],
        );
        assert_eq!((tally.galdebris, tally.holes), (2, 2), "{fill_mode:?}");
    }
}

#[test]
fn what_extend_continued_loses_against_a_galpixel_however_near_it_is() {
    let before = &["BBAA  33cc  {{--", "....  ....  ....", "D...  f...  ^..."];
    let after: &[&[&str]] = &[
        &["aaAA  !!##  cccc", "D...  #...  f...", "d...  !...  f..."],
        // D is behind what was put there, and comes from a galpixel of the update.
        &["DaAA  #~##  fccc", "d...  ~...  f...", "d...  !...  f..."],
    ];
    let tally = frames(FillMode::Extend, &[Colour, Classes, Depth], before, after);
    assert_eq!((tally.collided, tally.lost), (1, 0));
}

/// What was never known is no surface, on either side: with nothing next to it, a cell is as galdebris leaves it.
#[test]
fn extend_does_not_continue_what_was_never_known() {
    let panels = &[Colour, Classes, Depth, Motion];
    for fill_mode in [FillMode::Galdebris, FillMode::Extend] {
        frames(
            fill_mode,
            panels,
            &["....  ....  ....", "B...  3...  ^..."],
            &[&["B...  #...  3...  ^...", "b...  !...  3...  ^..."]],
        );
        frames(
            fill_mode,
            panels,
            &["....  ....  ....", "..B.  ..3.  ..^."],
            &[&["..B.  ..#.  ..3.  ..^.", "..b.  ..!.  ..3.  ..^."]],
        );
    }
}

#[test]
fn a_cell_of_which_nothing_was_ever_known_keeps_its_colour() {
    for fill_mode in FillMode::ALL {
        with_drawing(&["AB....  c3....  -}...."], |controller| {
            let colour_only = Galpixel { class: Class::Empty, colour: [24; 3], ..Galpixel::default() };
            controller.front_mut().store(4, 0, &colour_only).unwrap();
            Art::of(controller.front(), &[Classes, Shown]).assert("before", &["##....  AB__C_"]);
            let tally = controller.step(&with_fill_mode(fill_mode));
            let row = match fill_mode {
                // Holes are shown black.
                FillMode::None => "#..#..  A__B__",
                FillMode::Hold => "#..#..  AB_BC_",
                FillMode::Debris => "#~.#..  AB_BC_",
                FillMode::Bullet | FillMode::Galdebris => "#!.#..  AB_BC_",
                FillMode::Extend => "#!.#..  AA_BC_",
            };
            Art::of(controller.front(), &[Classes, Shown]).assert(fill_mode.name(), &[row]);
            assert!(tally.empty >= 3, "{fill_mode:?}: {tally:?}");
        });
    }
}

#[test]
fn static_debris_stays_behind_without_motion_as_far_away_as_can_be() {
    let before = &["AB......  33......  }}......"];
    let after: &[&[&str]] = &[&["abAB....  ~~##....  **33....  --}}...."], &["ababAB..  ~~~~##..  ****33..  ----}}.."]];
    let tally = frames(FillMode::Debris, &[Colour, Classes, Depth, Motion], before, after);
    assert_eq!((tally.debris, tally.holes), (2, 4));
    // Debris that stays is propagated like anything else and is no hole: it lies where it lay.
    assert_eq!(tally.moved, 4);
}

#[test]
fn sample_and_hold_keeps_showing_what_was_shown() {
    let before = &["AB......  33......  }}......"];
    frames(FillMode::Hold, &[Colour, Shown], before, &[&["..AB....  ABAB____"], &["....AB..  ABABAB__"]]);
    frames(FillMode::None, &[Colour, Shown], before, &[&["..AB....  __AB____"], &["....AB..  ____AB__"]]);
}

#[test]
fn motion_that_is_no_whole_cell_arrives_when_it_is_due() {
    frames(FillMode::None, &[Colour], &["A....  4....  )...."], &[&[".A..."], &[".A..."], &["..A.."], &["..A.."]]);
    frames(FillMode::None, &[Colour], &["....A  ....4  ....("], &[&["....A"], &["...A."], &["...A."], &["..A.."]]);
}

fn edges(drawing: &[&str], threshold: u32, change: impl Fn(&mut Galpixel)) -> Vec<String> {
    let drawing = Drawing(drawing);
    let shape = drawing.shape();
    with_maps(shape, format(), None, |mut front, _| {
        drawing.store(&mut front, change);
        let mut edges = vec![u32::MAX; words(front.grid())];
        let count = mark(&front, threshold, &mut edges);
        let art: Vec<String> = (0..shape.height)
            .map(|y| {
                let cells = (0..shape.width).map(|x| on_edge(&edges, y * shape.width + x));
                cells.map(|edge| if edge { '+' } else { ' ' }).collect()
            })
            .collect();
        assert_eq!(count as usize, art.join("").matches('+').count(), "counted and marked");
        let spare = edges.iter().map(|word| word.count_ones()).sum::<u32>();
        assert_eq!(spare, count, "no bit beyond the last cell");
        art
    })
}

#[test]
fn a_step_has_an_edge_on_both_sides() {
    let step = ["AAABBB  444ccc  ------", "AAABBB  444ccc  ------"];
    assert_eq!(edges(&step, threshold_for_depth(20), |_| ()), ["  ++  ", "  ++  "]);
    let square = [
        "AAAAAAA  8888888  -------",
        "AAAAAAA  8888888  -------",
        "AABBBAA  8844488  -------",
        "AABBBAA  8844488  -------",
        "AABBBAA  8844488  -------",
        "AAAAAAA  8888888  -------",
    ];
    let expected = ["       ", "  +++  ", " +++++ ", " ++ ++ ", " +++++ ", "  +++  "];
    assert_eq!(edges(&square, threshold_for_depth(20), |_| ()), expected);
}

#[test]
fn a_slanted_plane_has_no_edge_but_where_it_ends_in_the_picture() {
    // The slope is the same everywhere; at the border a missing neighbour counts as level.
    let plane = ["AAAAAAA  2345678  -------", "AAAAAAA  3456789  -------", "AAAAAAA  456789a  -------"];
    assert_eq!(edges(&plane, 0, |_| ()), ["++++++ ", "+     +", " ++++++"]);
    // The slope is within bounds at a side; in two of the corners it counts twice, in the others not at all.
    let sixteenth = 1 << 16;
    assert_eq!(edges(&plane, sixteenth, |_| ()), ["+      ", "       ", "      +"]);
    let gentle = |galpixel: &mut Galpixel| galpixel.depth >>= 4;
    assert_eq!(edges(&plane, threshold_for_depth(20), gentle), ["       "; 3]);
}

#[test]
fn the_threshold_itself_is_inside() {
    let bump = ["AAAA  4454  ----"];
    let sixteenth = 1 << 16;
    assert_eq!(edges(&bump, 2 * sixteenth, |_| ()), ["    "]);
    assert_eq!(edges(&bump, 2 * sixteenth - 1, |_| ()), ["  + "]);
    assert_eq!(edges(&bump, sixteenth - 1, |_| ()), [" +++"]);
}

#[test]
fn what_lies_beside_a_hole_is_on_an_edge_and_debris_has_a_depth() {
    let hole = ["AAAAA  44444  -----", "AA.AA  44.44  --.--", "AAAAA  44444  -----", "AAAAA  44444  -----"];
    assert_eq!(edges(&hole, threshold_for_depth(20), |_| ()), ["  +  ", " +++ ", "  +  ", "     "]);
    let debris = ["AAAAA  44444  -----", "AAaAA  44444  -----", "AAAAA  44444  -----", "AAAAA  44444  -----"];
    assert_eq!(edges(&debris, threshold_for_depth(20), |_| ()), ["     "; 4], "debris is of its surface");
    let debris = ["AAAAA  44444  -----", "AAaAA  44944  -----", "AAAAA  44444  -----", "AAAAA  44444  -----"];
    assert_eq!(edges(&debris, threshold_for_depth(20), |_| ()), ["  +  ", " +++ ", "  +  ", "     "]);
    assert_eq!(edges(&["aaa  444  ---", "aaa  444  ---"], 0, |_| ()), ["   ", "   "], "debris has an inside");
    assert_eq!(edges(&["...  ...  ..."], u32::MAX, |_| ()), ["+++"], "a hole has none");
    assert_eq!(edges(&["A  4  -"], 0, |_| ()), [" "], "a galpixel alone has no neighbour that decides");
}

#[test]
#[should_panic(expected = "where they differ:\n    .A.   .B.    x")]
fn a_failure_shows_both_pictures_and_the_difference() {
    frames(FillMode::None, &[Colour], &["A.B  5.3  >.<"], &[&[".A."]]);
}
