//! Grafting: a late update gives what one in time would have given.

use fixed::types::I32F32;
use galpix_core::edge;
use galpix_core::fill::Rung;
use galpix_core::frame::Settings;
use galpix_core::galpixel::{Budget, Galpixel, Profile, Static};
use galpix_core::galpixmap::Galpixmap;
use galpix_core::graft::{Graft, Grafted};
use galpix_core::layout::{Flat565, Full, Layout, Velocity565};
use galpix_core::rounding::Rounding;
use galpix_tests::lent::{Shape, cell_words, with_controller, with_maps};
use galpix_tests::profiles::{Paper, Scene, Slide};
use galpix_tests::stage::{self, number};

/// Takes all scenes `late` frames further, once as maps without any fill, and once galpixel by galpixel into a map of
/// something else: the cells that an update in time reaches hold the same words, unless something was lost in a collision
/// on the way that is there in the end.
fn late_is_in_time<L: Layout, P: Profile>(rounding: Rounding, late: u32) {
    let budget = Static::<P>::new();
    for stage in stage::all() {
        let content = stage.content::<L, _>(budget, |_| ());
        let (columns, rows) = (stage.shape.columns() as i32, stage.shape.rows() as i32);
        let words = Budget::<L>::record(&budget).words();
        let cells = stage.shape.cells() as usize;
        let stamp = u32::MAX - 1;
        let update = |cell: usize| -> Vec<u32> { (0..words).map(|word| content[word * cells + cell]).collect() };
        let grafted = with_maps::<L, _, _>(stage.shape, budget, None, |mut map, _| {
            let mut reached = vec![7; edge::words(map.grid())];
            let mut graft = Graft::new(&mut reached, rounding);
            let mut put = 0;
            // From the last cell on, so that nothing depends on the order.
            for cell in (0..cells).rev() {
                let (x, y) = (cell as i32 % columns, cell as i32 / columns);
                assert!(y < rows);
                let now = stamp.wrapping_add(late);
                put += u32::from(matches!(graft.put(&mut map, x, y, &update(cell), stamp, now), Grafted::Put(_)));
            }
            assert!(put > 0);
            (0..cells).map(|cell| cell_words(&map, cell as u32)).collect::<Vec<_>>()
        });
        let settings = Settings { rounding, rung: Rung::None, ..Settings::for_depth(16) };
        with_controller::<L, _, _>(stage.shape, budget, Some(&content), |controller| {
            controller.set_frame(stamp);
            let mut collided = 0;
            for _ in 0..late {
                collided += controller.step(&settings).collided;
            }
            let front = controller.front();
            let mut differ = 0;
            for cell in 0..front.grid().cells() {
                let in_time = cell_words(front, cell);
                differ += u32::from(
                    front.class(cell) != galpix_core::galpixel::Class::Empty && in_time != grafted[cell as usize],
                );
            }
            // One that lost a collision on the way is gone in the map, and may lie elsewhere and nearer when grafted.
            assert!(differ <= collided, "{}: {differ} cells differ, {collided} collided", stage.scene.name());
            assert!(stage.scene.name() != "pan" || differ == 0, "a pan has no collisions");
        });
    }
}

#[test]
fn a_late_update_is_where_it_would_have_been() {
    late_is_in_time::<Full, Paper>(Rounding::LowDiscrepancy, 5);
    late_is_in_time::<Flat565, Scene>(Rounding::Nearest, 3);
    late_is_in_time::<Velocity565, Slide>(Rounding::Truncate, 7);
}

/// Stored words of a galpixel at a depth.
fn at_depth(map: &mut Galpixmap<'_, Velocity565, Static<Slide>>, depth: f64, velocity: f64) -> Vec<u32> {
    let velocity = [number(velocity), I32F32::ZERO, I32F32::ZERO];
    map.store(0, 0, &Galpixel { depth: number(depth), velocity, ..Galpixel::default() }).unwrap();
    let words = cell_words(map, 0);
    map.clear();
    words
}

#[test]
fn the_newer_wins_and_among_its_own_the_nearer() {
    with_maps::<Velocity565, _, _>(Shape::plain(9, 2), Static::<Slide>::new(), None, |mut map, _| {
        let [near, middle, far] = [0.25, 0.5, 0.75].map(|depth| at_depth(&mut map, depth, 1.0));
        let mut reached = vec![0; edge::words(map.grid())];
        let held = |map: &Galpixmap<'_, Velocity565, _>| cell_words(map, 3);
        // An update in which all three want cell 3: two frames late, from cell 1.
        for order in [[&near, &middle, &far], [&far, &middle, &near], [&middle, &far, &near]] {
            let mut graft = Graft::new(&mut reached, Rounding::LowDiscrepancy);
            for words in order {
                graft.put(&mut map, 1, 0, words, 7, 9);
            }
            assert_eq!(held(&map), near);
        }
        // A newer update replaces it by something farther.
        let mut graft = Graft::new(&mut reached, Rounding::LowDiscrepancy);
        assert_eq!(graft.put(&mut map, 3, 0, &far, 9, 9), Grafted::Put(3));
        assert_eq!(held(&map), far);
        assert_eq!(graft.put(&mut map, 3, 0, &far, 9, 9), Grafted::Behind, "of equal keys the first stays");
        // The rest of the same update, after a pause.
        let mut graft = Graft::again(&mut reached, Rounding::LowDiscrepancy);
        assert_eq!(graft.put(&mut map, 3, 0, &middle, 9, 9), Grafted::Put(3));
        assert_eq!(graft.put(&mut map, 3, 0, &far, 9, 9), Grafted::Behind);
        // Over the border, from outside, and nothing at all.
        assert_eq!(graft.put(&mut map, 7, 0, &near, 0, 2), Grafted::Lost);
        assert_eq!(graft.put(&mut map, 9, 0, &near, 0, 0), Grafted::Lost);
        assert_eq!(graft.put(&mut map, 0, -1, &near, 0, 0), Grafted::Lost);
        assert_eq!(graft.put(&mut map, 0, 0, &[u32::MAX; 8], 0, 0), Grafted::Empty);
    });
}
