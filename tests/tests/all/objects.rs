//! Grafting objects against a slow reference: each galpixel alone in a map of its own for the frames that it missed,
//! then the smallest of each cell by hand.

use std::collections::VecDeque;

use galpix_core::layers::{Layer, Layers, Stationary, composite_words};
use galpix_core::objects::{Limits, Object, ObjectsTally, Places, Queue, Refusal, Refusals, replace};
use galpix_core::{
    Class, Controller, Dynamic, Format, Galpixel, Galpixmap, Grid, Layout, Margin, Rounding, Scratch, Settings,
    SetupError, stages,
};
use galpix_tests::memory::{Shape, cell_words, with_controller, with_maps, words};
use galpix_tests::packed;
use galpix_tests::profiles::{ODD, PAPER, SCENE, dynamic};
use galpix_tests::random::{below, generator};
use galpix_tests::stage::number;
use galpix_vectors::arrivals::arrivals;
use rand::Rng;

const SHAPE: Shape = Shape::new(9, 6, [1, 2, 0, 1]);
const CELLS: u32 = SHAPE.cells();

/// Returns a random galpixel: of four depths, so that keys are often equal, four tags, and slow enough to stay for a
/// while.
fn random_galpixel(random: &mut impl Rng) -> Galpixel {
    let mut slow = || number(f64::from(below(random, 17)) / 8.0 - 1.0);
    let (velocity, acceleration) = ([slow(), slow(), number(0.0)], [slow() / 8, slow() / 8, number(0.0)]);
    Galpixel {
        class: Class::from_bits(below(random, 5)),
        colour: [below(random, 256) as u8, below(random, 256) as u8, below(random, 256) as u8],
        depth: number(f64::from(below(random, 4)) / 4.0),
        velocity,
        acceleration,
        tag: below(random, 4),
        ..Galpixel::default()
    }
}

/// A map as cells of words.
type Cells = Vec<Vec<u32>>;

fn cells(map: &Galpixmap<'_, Dynamic>) -> Cells {
    (0..map.grid().cells()).map(|cell| cell_words(map, cell)).collect()
}

/// The section on grafting objects, word for word.
struct Slowly {
    format: Dynamic,
    rounding: Rounding,
    now: u32,
}

impl Slowly {
    /// Returns where a galpixel is after the frames from `stamp` to `now`, if the map still has it.
    fn alone(&self, cell: u32, galpixel: &[u32], stamp: u32) -> Option<(u32, Vec<u32>)> {
        let (mut cell, mut galpixel, mut frame) = (cell, galpixel.to_vec(), stamp);
        while frame != self.now {
            let length = galpixel.len();
            let mut content = with_maps(SHAPE, self.format, None, |map, _| words(&map));
            for (plane, &word) in galpixel.iter().enumerate() {
                content[plane * CELLS as usize + cell as usize] = word;
            }
            (cell, galpixel) = with_maps(SHAPE, self.format, Some(&content), |map, _| {
                let [arrival] = arrivals(&map, self.rounding, frame).try_into().expect("it alone is there");
                Some((arrival.cell?, arrival.words[..length].to_vec()))
            })?;
            frame = frame.wrapping_add(1);
        }
        Some((cell, galpixel))
    }

    /// Replaces an object.
    fn replace(&self, map: &mut Cells, object: &Object, given: &[u32]) -> ObjectsTally {
        let record = self.format.record();
        let class = |words: &[u32]| packed::unsigned(record.class(), words);
        let tag = |words: &[u32]| packed::unsigned(record.tag(), words);
        let mut tally = ObjectsTally { renderings: 1, ..ObjectsTally::default() };
        for words in map.iter_mut() {
            if class(words) != 3 && tag(words) == i64::from(object.tag) {
                let colour = packed::unsigned(record.colour(), words);
                words.fill(0);
                packed::set(record.class(), words, 3);
                packed::set(record.colour(), words, colour);
                tally.removed += 1;
            }
        }
        let mut candidates: Vec<Vec<Vec<u32>>> = vec![Vec::new(); map.len()];
        for (index, galpixel) in (0..).zip(given.chunks(record.words())) {
            let mut galpixel = galpixel.to_vec();
            packed::set(record.tag(), &mut galpixel, i64::from(object.tag));
            if class(&galpixel) == 3 {
                tally.empty += 1;
                continue;
            }
            let (x, y) = (object.place[0] + index % object.size[0], object.place[1] + index / object.size[0]);
            let cell = y * SHAPE.columns() + x;
            match self.alone(cell, &galpixel, object.stamp) {
                Some((cell, galpixel)) => candidates[cell as usize].push(galpixel),
                None => tally.lost += 1,
            }
        }
        for (held, candidates) in map.iter_mut().zip(candidates) {
            let key = |words: &[u32]| (class(words), packed::unsigned(record.depth(), words));
            let incumbent = held.clone();
            // `min_by_key` gives the first of equals.
            let all = std::iter::once(&incumbent).filter(|words| class(words) != 3).chain(&candidates);
            let Some(best) = all.min_by_key(|words| key(words)) else { continue };
            let new = !std::ptr::eq(best, &raw const incumbent);
            tally.put += u32::from(new);
            tally.replaced += u32::from(new && class(&incumbent) != 3);
            tally.behind += candidates.len() as u32 - u32::from(new);
            held.clone_from(best);
        }
        tally
    }
}

/// Returns a random rendering within the map: rectangle, layer 0, words.
fn random_object(map: &Galpixmap<'_, Dynamic>, random: &mut impl Rng, now: u32, late: u32) -> (Object, Vec<u32>) {
    let place = [below(random, SHAPE.columns()), below(random, SHAPE.rows())];
    let size = [below(random, SHAPE.columns() - place[0] + 1), below(random, SHAPE.rows() - place[1] + 1)];
    let object = Object { tag: below(random, 4), layer: 0, stamp: now.wrapping_sub(late), place, size };
    let count = map.record().words();
    let words = (0..size[0] * size[1]).flat_map(|_| map.stored(&random_galpixel(random)).0[..count].to_vec()).collect();
    (object, words)
}

fn random_map(map: &mut Galpixmap<'_, Dynamic>, random: &mut impl Rng) {
    for (x, y) in (0..SHAPE.rows() as i32).flat_map(|y| (0..SHAPE.columns() as i32).map(move |x| (x, y))) {
        map.store(x, y, &random_galpixel(random));
    }
}

fn replaces_as_the_reference(format: Dynamic, seed: u64) {
    let mut random = generator(seed);
    let mut all = ObjectsTally::default();
    for round in 0..60 {
        let rounding = Rounding::ALL[round % 4];
        with_maps(SHAPE, format, None, |mut map, _| {
            random_map(&mut map, &mut random);
            let mut reference = cells(&map);
            for now in [0, 7, u32::MAX] {
                let late = below(&mut random, 4);
                let (object, words) = random_object(&map, &mut random, now, late);
                let tally = replace(&mut map, &object, words.iter().copied(), rounding, now);
                let slowly = Slowly { format, rounding, now };
                let expected = slowly.replace(&mut reference, &object, &words);
                assert_eq!(ObjectsTally { saturated: 0, ..tally }, expected, "round {round}: {object:?}");
                assert!(cells(&map) == reference, "round {round}: {object:?}");
                let given = object.size[0] * object.size[1];
                assert_eq!(tally.put + tally.behind + tally.lost + tally.empty, given);
                for (sum, more) in [
                    (&mut all.removed, tally.removed),
                    (&mut all.put, tally.put),
                    (&mut all.behind, tally.behind),
                    (&mut all.lost, tally.lost),
                    (&mut all.empty, tally.empty),
                    (&mut all.replaced, tally.replaced),
                ] {
                    *sum += more;
                }
            }
        });
    }
    let ObjectsTally { removed, put, behind, lost, empty, replaced, .. } = all;
    assert!([removed, put, behind, lost, empty, replaced].iter().all(|&count| count > 60), "{all:?}");
}

#[test]
fn an_object_is_replaced_as_the_reference_says() {
    replaces_as_the_reference(dynamic(Layout::TAGGED, PAPER), 1);
    replaces_as_the_reference(dynamic(Layout::SHADED, SCENE), 2);
    replaces_as_the_reference(dynamic(Layout::SHADED, ODD), 3);
}

/// It would turn round beyond the border: in the map it would have been lost there.
#[test]
fn who_has_left_on_the_way_does_not_come_back() {
    with_maps(SHAPE, dynamic(Layout::TAGGED, PAPER), None, |mut map, _| {
        let [velocity, acceleration] = [-3.0, 3.0].map(|x| [number(x), number(0.0), number(0.0)]);
        let count = map.record().words();
        let words = map.stored(&Galpixel { velocity, acceleration, ..Galpixel::default() }).0;
        let mut put = |x: u32, late: u32| {
            let object = Object { tag: 1, layer: 0, stamp: 0, place: [x, 2], size: [1, 1] };
            let tally = replace(&mut map, &object, words[..count].iter().copied(), Rounding::Nearest, late);
            (tally.put, tally.lost)
        };
        // -1.5 cells in the first step, 1.5 back in the second.
        assert_eq!([put(0, 0), put(0, 1), put(0, 2), put(0, 3)], [(1, 0), (0, 1), (0, 1), (0, 1)]);
        assert_eq!([put(3, 1), put(3, 2)], [(1, 0); 2]);
    });
}

const UPDATES: usize = 4;
const LIMITS: Limits = Limits { cells_each: 20, cells: 31, age: 3 };

/// A queue against a list: what waits, what is refused and why, in which order and how much enters at once.
#[test]
fn a_queue_is_a_list_within_its_limits() {
    let format = dynamic(Layout::TAGGED, PAPER);
    let mut random = generator(4);
    let mut counted = Refusals::default();
    let (mut entered, mut put) = (0, 0);
    with_controller(SHAPE, format, None, |controller| {
        let mut memory = vec![0; Queue::words(format, LIMITS.cells) + 5];
        let mut places = Places::<UPDATES>::new();
        let mut queue = Queue::new(format, LIMITS, places.as_mut_view(), &mut memory).unwrap();
        let mut list: VecDeque<(Object, Vec<u32>)> = VecDeque::new();
        controller.set_frame(u32::MAX - 100);
        random_map(controller.front_mut(), &mut random);
        for turn in 0..4000 {
            let now = controller.frame();
            let late = below(&mut random, 6);
            // Some are for a frame to come.
            let (object, words) = random_object(controller.front(), &mut random, now.wrapping_add(1), late);
            let waiting: u32 = list.iter().map(|(object, _)| object.size[0] * object.size[1]).sum();
            let cells = object.size[0] * object.size[1];
            let expected = if cells > 20 {
                counted.cells += 1;
                Err(Refusal::Cells { cells, most: 20 })
            } else if late == 0 {
                counted.ahead += 1;
                Err(Refusal::Ahead { frames: 1 })
            } else if late > 4 {
                counted.age += 1;
                Err(Refusal::Age { age: 4, most: 3 })
            } else if list.len() == UPDATES {
                counted.queue += 1;
                Err(Refusal::Queue { most: UPDATES })
            } else if waiting + cells > LIMITS.cells {
                counted.memory += 1;
                Err(Refusal::Memory { cells, left: LIMITS.cells - waiting })
            } else {
                list.push_back((object, words.clone()));
                Ok(())
            };
            assert_eq!(queue.submit(controller, &object, &words), expected, "turn {turn}");
            if below(&mut random, 4) == 0 {
                let most = below(&mut random, 45);
                let mut reference = self::cells(controller.front());
                let (mut expected, mut handled, mut begun) = (ObjectsTally::default(), 0, 0);
                while let Some((object, words)) = list.front() {
                    let cells = object.size[0] * object.size[1];
                    if begun > 0 && handled + cells > most {
                        break;
                    }
                    if now.wrapping_sub(object.stamp) > LIMITS.age {
                        counted.age += 1;
                    } else {
                        let rounding = Rounding::LowDiscrepancy;
                        let tally = Slowly { format, rounding, now }.replace(&mut reference, object, words);
                        expected = ObjectsTally {
                            renderings: expected.renderings + 1,
                            removed: expected.removed + tally.removed,
                            put: expected.put + tally.put,
                            behind: expected.behind + tally.behind,
                            lost: expected.lost + tally.lost,
                            empty: expected.empty + tally.empty,
                            replaced: expected.replaced + tally.replaced,
                            saturated: 0,
                        };
                        (handled, begun) = (handled + cells, begun + 1);
                    }
                    list.pop_front();
                }
                let tally = queue.apply(controller, Rounding::LowDiscrepancy, most);
                assert_eq!(ObjectsTally { saturated: 0, ..tally }, expected, "turn {turn}");
                assert!(self::cells(controller.front()) == reference, "turn {turn}");
                (entered, put) = (entered + tally.renderings, put + tally.put);
            }
            if below(&mut random, 3) == 0 {
                // The counter alone moves on: what enters where is not the question here.
                controller.set_frame(now.wrapping_add(1));
            }
            let waiting: u32 = list.iter().map(|(object, _)| object.size[0] * object.size[1]).sum();
            assert_eq!((queue.waiting(), queue.left()), (list.len(), LIMITS.cells - waiting), "turn {turn}");
            assert_eq!(queue.refusals(), counted, "turn {turn}");
        }
        assert_eq!(memory[memory.len() - 5..], [0; 5], "words beyond the limit are not touched");
    });
    let Refusals { cells, age, ahead, queue, memory, .. } = counted;
    assert!([cells, age, ahead, queue, memory, entered].iter().all(|&count| count > 30), "{counted:?} {entered}");
    assert!(put > 500, "{put}");
}

#[test]
fn what_is_refused_changes_nothing() {
    let format = dynamic(Layout::TAGGED, PAPER);
    with_controller(SHAPE, format, None, |controller| {
        random_map(controller.front_mut(), &mut generator(5));
        let mut memory = vec![0; Queue::words(format, 30)];
        let mut places = Places::<1>::new();
        let limits = Limits { cells_each: 12, cells: 30, age: 8 };
        let mut queue = Queue::new(format, limits, places.as_mut_view(), &mut memory).unwrap();
        let before = words(controller.front());
        let good = Object { tag: 3, layer: 0, stamp: 0, place: [2, 1], size: [3, 2] };
        let given = vec![0; queue_words(6)];
        let (columns, rows) = (SHAPE.columns(), SHAPE.rows());
        let bad = [
            (Object { tag: 256, ..good }, Refusal::Tag { tag: 256, bits: 8 }),
            (Object { tag: u32::MAX, ..good }, Refusal::Tag { tag: u32::MAX, bits: 8 }),
            (Object { layer: 1, ..good }, Refusal::Layer { layer: 1 }),
            (Object { layer: u32::MAX, ..good }, Refusal::Layer { layer: u32::MAX }),
            (Object { place: [columns - 2, 1], ..good }, Refusal::Place { place: [columns - 2, 1], size: [3, 2] }),
            (Object { place: [2, rows - 1], ..good }, Refusal::Place { place: [2, rows - 1], size: [3, 2] }),
            (Object { place: [u32::MAX, 0], ..good }, Refusal::Place { place: [u32::MAX, 0], size: [3, 2] }),
            (Object { size: [3, u32::MAX], ..good }, Refusal::Place { place: [2, 1], size: [3, u32::MAX] }),
            (Object { size: [4, 4], ..good }, Refusal::Cells { cells: 16, most: 12 }),
            (Object { size: [3, 3], ..good }, Refusal::Words { need: queue_words(9), have: queue_words(6) }),
            (Object { size: [3, 1], ..good }, Refusal::Words { need: queue_words(3), have: queue_words(6) }),
            (Object { stamp: 5, ..good }, Refusal::Ahead { frames: 5 }),
            (Object { stamp: u32::MAX - 8, ..good }, Refusal::Age { age: 9, most: 8 }),
        ];
        for (object, refusal) in bad {
            assert_eq!(queue.submit(controller, &object, &given), Err(refusal), "{object:?}");
            let sentence = refusal.to_string();
            assert!(sentence.contains(": ") && !sentence.contains('\n') && sentence.len() < 160, "{sentence}");
        }
        assert_eq!(queue.submit(controller, &good, &given), Ok(()));
        assert_eq!(queue.submit(controller, &good, &given), Err(Refusal::Queue { most: 1 }));
        let expected =
            Refusals { tag: 2, layer: 2, place: 4, cells: 1, words: 2, ahead: 1, age: 1, queue: 1, memory: 0 };
        assert_eq!((queue.refusals(), queue.refusals().total()), (expected, 14));
        assert!(words(controller.front()) == before && queue.waiting() == 1);
        // What was taken is still what was given.
        assert_eq!(queue.apply(controller, Rounding::Nearest, 0).renderings, 1);
        assert!(words(controller.front()) != before);
    });
}

fn queue_words(cells: u32) -> usize {
    Queue::words(dynamic(Layout::TAGGED, PAPER), cells)
}

#[test]
fn a_queue_says_what_it_needs() {
    let mut memory = [0; 10];
    let limits = Limits { cells_each: 4, cells: 4, age: 1 };
    let mut places = Places::<1>::new();
    let untagged = Queue::new(dynamic(Layout::FULL, PAPER), limits, places.as_mut_view(), &mut memory);
    assert_eq!(untagged.err(), Some(SetupError::NoTag));
    assert!(SetupError::NoTag.to_string().contains("tag bits"));
    let short = Queue::new(dynamic(Layout::TAGGED, PAPER), limits, places.as_mut_view(), &mut memory);
    let need = queue_words(4);
    let plane = "memory of waiting renderings";
    assert_eq!(short.err(), Some(SetupError::TooShort { plane, need, have: 10 }));
}

/// A ball passes behind a pillar and in front of a wall, three layers. While it is covered it is rendered anew: faster,
/// and of other colours. Nothing else changes, and it reappears where it should be by then.
#[test]
fn an_object_that_is_covered_is_replaced_in_its_own_layer() {
    const WIDTH: u32 = 48;
    const BALL: i32 = 6;
    let format = dynamic(Layout::TAGGED, PAPER);
    let mut rows = [0; 2];
    let grid = Grid::new(WIDTH, 2, Margin::NONE, &mut rows).unwrap();
    let mut memory = vec![vec![0; Galpixmap::words(&grid, format)]; 9];
    let [m0, m1, m2, m3, m4, m5, m6, m7, m8] = memory.as_mut_slice() else { unreachable!() };
    let map = |memory| Galpixmap::new(grid, format, memory).unwrap();
    let (mut winners, mut edges) = (vec![0; grid.cells() as usize], vec![0; stages::words(&grid)]);
    let (mut composited, mut displacements) =
        (vec![vec![0; composite_words(&grid)]; 3], vec![0; grid.cells() as usize]);
    let [s1, s2, s3] = composited.as_mut_slice() else { unreachable!() };
    let base = Controller::new(map(m0), map(m1), Scratch { winners: &mut winners, edges: &mut edges }).unwrap();
    let moving = |front, back, composited| Layer::new(front, back, Scratch::default(), composited).unwrap();
    let stationary = Layer::stationary(
        Stationary { stored: map(m6), displacements: &mut displacements },
        map(m7),
        map(m8),
        &mut [],
        s3,
    );
    let mut hidden = [moving(map(m2), map(m3), s1), moving(map(m4), map(m5), s2), stationary.unwrap()];
    let mut layers = Layers::new(base, &mut hidden).unwrap();
    let ball = |x: i32, shade: u8, speed: f64| Galpixel {
        colour: [shade + x as u8; 3],
        depth: number(0.5),
        velocity: [number(speed), number(0.0), number(0.0)],
        tag: 2,
        ..Galpixel::default()
    };
    for (x, y) in (0..2).flat_map(|y| (0..WIDTH as i32).map(move |x| (x, y))) {
        let still = |colour: i32, depth, tag| Galpixel {
            colour: [colour as u8; 3],
            depth: number(depth),
            tag,
            ..Galpixel::default()
        };
        layers.layer_mut(0).unwrap().store(x, y, &still(100 + x, 0.75, 1));
        if (2..2 + BALL).contains(&x) {
            layers.layer_mut(1).unwrap().store(x, y, &ball(x - 2, 10, 1.0));
        }
        if (12..24).contains(&x) {
            layers.layer_mut(2).unwrap().store(x, y, &still(200 + x, 0.25, 3));
        }
    }
    layers.composite();
    let limits = Limits { cells_each: 12, cells: 12, age: 4 };
    let mut memory = vec![0; Queue::words(format, 12)];
    let mut places = Places::<2>::new();
    let mut queue = Queue::new(format, limits, places.as_mut_view(), &mut memory).unwrap();
    let settings = Settings::for_depth(16);
    for frame in 0..22_i32 {
        if frame == 13 {
            // Exact two frames ago, when its left end was at column 2 + 11.
            let place = [13, 0];
            let object = Object { tag: 2, layer: 1, stamp: 11, place, size: [BALL as u32, 2] };
            let count = layers.front().record().words();
            let stored = |x| layers.front().stored(&ball(x, 30, 2.0)).0[..count].to_vec();
            let given: Vec<u32> = (0..2).flat_map(|_| (0..BALL).flat_map(stored).collect::<Vec<_>>()).collect();
            for layer in [3, 4] {
                let refused = queue.submit(&layers, &Object { layer, ..object }, &given);
                assert_eq!(refused, Err(Refusal::Layer { layer }), "stationary, and none");
            }
            queue.submit(&layers, &object, &given).unwrap();
            let others =
                |layers: &mut Layers<'_, '_, Dynamic>| [0, 2].map(|layer| words(layers.layer_mut(layer).unwrap()));
            let before = others(&mut layers);
            let tally = queue.apply(&mut layers, settings.rounding, u32::MAX);
            let cells = 2 * BALL as u32;
            assert_eq!(tally, ObjectsTally { renderings: 1, removed: cells, put: cells, ..ObjectsTally::default() });
            assert!(others(&mut layers) == before, "the others move on untouched");
            layers.composite();
        }
        let (left, shade) = if frame < 13 { (2 + frame, 10) } else { (13 + 2 * (frame - 11), 30) };
        for x in 0..WIDTH as i32 {
            let expected = match x {
                12..24 => 200 + x,
                _ if (left..left + BALL).contains(&x) => shade + x - left,
                _ => 100 + x,
            };
            assert_eq!(layers.front().rgb888(x, 1), Some([expected as u8; 3]), "frame {frame}, column {x}");
        }
        let tally = layers.step(&settings);
        assert_eq!((tally.holes, tally.lost), (0, 0), "frame {frame}");
    }
}
