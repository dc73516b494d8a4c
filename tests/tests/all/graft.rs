//! Grafting: a late update gives what one in time would have given.

use fixed::types::I32F32;
use galpix_core::{Class, Delay, Dynamic, FillMode, Format, Galpixel, Grafted, Layout, Rounding, Settings, graft};
use galpix_tests::memory::{Shape, cell_words, with_controller, with_maps};
use galpix_tests::profiles::{PAPER, SCENE, SLIDE, dynamic};
use galpix_tests::stage::{self, number};

/// Takes all scenes `late` frames further, once as maps without any fill, and once galpixel by galpixel into a map of
/// something else: the cells that an update in time reaches hold the same words, unless something was lost in a
/// collision on the way that is there in the end.
fn late_is_in_time(format: Dynamic, rounding: Rounding, late: u32) {
    for stage in stage::all() {
        let content = stage.content(format, |_| ());
        let columns = stage.shape.columns() as i32;
        let words = format.record().words();
        let cells = stage.shape.cells() as usize;
        let stamp = u32::MAX - 1;
        let update = |cell: usize| -> Vec<u32> { (0..words).map(|word| content[word * cells + cell]).collect() };
        let grafted = with_maps(stage.shape, format, None, |mut map, _| {
            let mut put = 0;
            // From the last cell on, so that nothing depends on the order.
            for cell in (0..cells).rev() {
                let place = (cell as i32 % columns, cell as i32 / columns);
                let now = stamp.wrapping_add(late);
                let grafted = graft(&mut map, place, &update(cell), Delay { stamp, now, rounding });
                put += u32::from(matches!(grafted, Grafted::Put(_)));
            }
            assert!(put > 0);
            (0..cells).map(|cell| cell_words(&map, cell as u32)).collect::<Vec<_>>()
        });
        let settings = Settings { rounding, fill_mode: FillMode::None, ..Settings::for_depth(16) };
        with_controller(stage.shape, format, Some(&content), |controller| {
            controller.set_frame(stamp);
            let mut collided = 0;
            for _ in 0..late {
                collided += controller.step(&settings).collided;
            }
            let front = controller.front();
            let mut differ = 0;
            for cell in 0..front.grid().cells() {
                let in_time = cell_words(front, cell);
                differ += u32::from(front.class(cell) != Class::Empty && in_time != grafted[cell as usize]);
            }
            // One that lost an earlier collision is gone in the map, and may lie elsewhere and nearer when grafted.
            assert!(differ <= collided, "{}: {differ} cells differ, {collided} collided", stage.scene.name());
            assert!(stage.scene.name() != "pan" || differ == 0, "a pan has no collisions");
        });
    }
}

#[test]
fn a_late_update_is_where_it_would_have_been() {
    late_is_in_time(dynamic(Layout::FULL, PAPER), Rounding::LowDiscrepancy, 5);
    late_is_in_time(dynamic(Layout::FLAT565, SCENE), Rounding::Nearest, 3);
    late_is_in_time(dynamic(Layout::VELOCITY565, SLIDE), Rounding::Truncate, 7);
}

#[test]
fn the_newer_wins_and_among_its_own_the_nearer() {
    with_maps(Shape::plain(9, 2), dynamic(Layout::TAGGED, PAPER), None, |mut map, _| {
        let mut words = |depth: f64, tag: u32| -> Vec<u32> {
            let velocity = [number(1.0), I32F32::ZERO, I32F32::ZERO];
            map.store(0, 0, &Galpixel { depth: number(depth), velocity, tag, ..Galpixel::default() }).unwrap();
            let words = cell_words(&map, 0);
            map.clear();
            words
        };
        let [near, middle, far] = [0.25, 0.5, 0.75].map(|depth| words(depth, 5));
        let newer = words(0.75, 6);
        let mut put = |x: i32, y: i32, words: &[u32], stamp: u32, now: u32| {
            let grafted = graft(&mut map, (x, y), words, Delay { stamp, now, rounding: Rounding::LowDiscrepancy });
            (grafted, cell_words(&map, 3))
        };
        // All three want cell 3: two frames late, from cell 1.
        for order in [[&near, &middle, &far], [&far, &middle, &near], [&middle, &far, &near]] {
            put(3, 0, &newer, 9, 9);
            let (_, held) = order.map(|words| put(1, 0, words, 7, 9))[2].clone();
            assert_eq!(held, put(1, 0, &near, 7, 9).1);
            assert_eq!(put(1, 0, &near, 7, 9).0, Grafted::Behind, "of equal keys the first stays");
            // A newer update replaces it by something farther.
            assert_eq!(put(3, 0, &newer, 9, 9), (Grafted::Put(3), newer.clone()));
        }
        // Over the border, from outside, and nothing at all.
        for (x, y, stamp, now) in [(7, 0, 0, 2), (9, 0, 0, 0), (0, -1, 0, 0), (-1, 0, 0, 1)] {
            assert_eq!(put(x, y, &near, stamp, now).0, Grafted::Lost);
        }
        assert_eq!(put(0, 0, &[u32::MAX; 8], 0, 0).0, Grafted::Empty);
    });
}

#[test]
fn without_a_tag_the_last_one_wins() {
    with_maps(Shape::plain(9, 2), dynamic(Layout::VELOCITY565, SLIDE), None, |mut map, _| {
        let [near, far] = [0.25, 0.75].map(|depth| {
            map.store(0, 0, &Galpixel { depth: number(depth), ..Galpixel::default() }).unwrap();
            cell_words(&map, 0)
        });
        for words in [&near, &far, &near, &near] {
            assert_eq!(
                graft(&mut map, (0, 0), words, Delay { stamp: 4, now: 4, rounding: Rounding::Nearest }),
                Grafted::Put(0)
            );
            assert_eq!(&cell_words(&map, 0), words);
        }
    });
}
