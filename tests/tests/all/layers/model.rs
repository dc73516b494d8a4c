//! Section 16 of the specification, slowly and from the text: separate maps, nothing is exchanged.

use galpix_core::layers::{Layer, Layers};
use galpix_core::stages::{NO_WINNER, snap, step_position};
use galpix_core::{Dynamic, FillMode, Format, Galpixmap, Record, Rounding, Settings, Tally};
use galpix_tests::memory::{Shape, cell_words, with_maps};
use galpix_tests::packed;
use galpix_vectors::arrivals::{arrivals, resolve};

use super::holes::{Cell, EMPTY, Holes, class, count, depth, edges};

/// Which scratch buffers a layer gets, and whether it is stationary.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kind {
    pub winners: bool,
    pub edges: bool,
    pub stationary: bool,
}

/// A layer: its own galpixels.
#[derive(Clone)]
pub struct Own {
    pub kind: Kind,
    /// As they are drawn; of a layer that is not stationary as they are.
    pub cells: Vec<Cell>,
    pub winners: Vec<u32>,
    /// Of a stationary layer what is stored, and how far from there it is drawn.
    pub stored: Vec<Cell>,
    pub displacements: Vec<[i64; 2]>,
}

/// What a frame counts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counts {
    /// In the base.
    pub base: Tally,
    /// In each further layer by itself.
    pub hidden: Vec<Tally>,
    /// Cells that show each further layer.
    pub shown: Vec<u32>,
}

impl Counts {
    /// Returns what the engine counted in its last step, whose base counted `base`.
    pub fn of(layers: &Layers<'_, '_, Dynamic>, base: Tally) -> Self {
        let hidden = layers.hidden();
        let (tallies, shown) = (hidden.iter().map(|layer| *layer.tally()), hidden.iter().map(Layer::shown));
        Self { base, hidden: tallies.collect(), shown: shown.collect() }
    }
}

pub struct Model {
    pub shape: Shape,
    pub format: Dynamic,
    pub layers: Vec<Own>,
    pub frame: u32,
    /// The edge map of the base's own map before.
    pub edges: Vec<bool>,
    /// What the base's own map was before.
    pub before: Vec<Cell>,
}

/// Returns all planes of a map.
pub fn planes(cells: &[Cell]) -> Vec<u32> {
    (0..cells[0].len()).flat_map(|word| cells.iter().map(move |cell| cell[word])).collect()
}

/// Returns the words of each cell of a map.
pub fn cells_of(map: &Galpixmap<'_, Dynamic>) -> Vec<Cell> {
    (0..map.grid().cells()).map(|cell| cell_words(map, cell)).collect()
}

/// Returns `cells` of x and y of section 5.
fn cells_moved(record: &Record, cell: &Cell, rounding: Rounding, frame: u32) -> [i64; 2] {
    [(0, record.offset_x()), (1, record.offset_y())].map(|(component, offset)| {
        let scale = &record.scales[component];
        let [r, v, a] = [offset, record.velocity(component), record.acceleration(component)]
            .map(|field| packed::signed(field, cell) as i32);
        snap(scale, step_position(scale, rounding.threshold(frame, scale.down), r, v, a)).into()
    })
}

impl Model {
    pub fn new(shape: Shape, format: Dynamic, contents: Vec<(Kind, Vec<Cell>)>) -> Self {
        let cells = shape.cells() as usize;
        let layers = contents.into_iter().map(|(kind, content)| Own {
            kind,
            cells: content.clone(),
            winners: vec![NO_WINNER; cells],
            stored: content,
            displacements: vec![[0, 0]; cells],
        });
        let mut model =
            Self { shape, format, layers: layers.collect(), frame: 0, edges: Vec::new(), before: Vec::new() };
        model.draw();
        model
    }

    fn record(&self) -> Record {
        *self.format.record()
    }

    /// Returns the arrivals of a map, resolved: the map, its winners and the counts.
    fn moved(&self, cells: &[Cell], rounding: Rounding) -> (Vec<Cell>, Vec<u32>, Tally) {
        let mut winners = vec![0; cells.len()];
        with_maps(self.shape, self.format, Some(&planes(cells)), |front, mut back| {
            let tally = resolve(arrivals(&front, rounding, self.frame), &mut back, &mut winners);
            (cells_of(&back), winners, tally)
        })
    }

    /// Draws the stationary layers.
    pub fn draw(&mut self) {
        for index in 0..self.layers.len() {
            if self.layers[index].kind.stationary {
                self.draw_layer(index);
            }
        }
    }

    fn draw_layer(&mut self, index: usize) -> Tally {
        let record = self.record();
        let columns = i64::from(self.shape.columns());
        let own = &mut self.layers[index];
        let mut wanted: Vec<Vec<usize>> = vec![Vec::new(); own.cells.len()];
        let mut tally = Tally::default();
        for source in (0..own.stored.len()).filter(|&source| class(&record, &own.stored[source]) != EMPTY) {
            tally.moved += 1;
            let [dx, dy] = own.displacements[source];
            let (x, y) = (source as i64 % columns + dx, source as i64 / columns + dy);
            if (0..columns).contains(&x) && (0..i64::from(self.shape.rows())).contains(&y) {
                wanted[(y * columns + x) as usize].push(source);
            } else {
                tally.lost += 1;
            }
        }
        let nothing = with_maps(self.shape, self.format, None, |map, _| cells_of(&map));
        for (cell, sources) in wanted.into_iter().enumerate() {
            tally.collided += sources.len().saturating_sub(1) as u32;
            let nearest = sources.into_iter().min_by_key(|&source| {
                (class(&record, &own.stored[source]), depth(&record, &own.stored[source]), source)
            });
            own.cells[cell] = nearest.map_or_else(|| nothing[cell].clone(), |source| own.stored[source].clone());
            own.winners[cell] = nearest.map_or(NO_WINNER, |source| source as u32);
        }
        tally
    }

    /// Returns the stored galpixels of a stationary layer one step later: each by itself, on a map where nothing else
    /// is.
    fn advance(&mut self, index: usize, rounding: Rounding) -> u32 {
        let record = self.record();
        let mut saturated = 0;
        let own = &self.layers[index];
        let mut next = own.clone();
        with_maps(self.shape, self.format, Some(&planes(&own.stored)), |front, _| {
            for arrival in arrivals(&front, rounding, self.frame) {
                let source = arrival.source as usize;
                next.stored[source] = arrival.words[..record.words()].to_vec();
                saturated += arrival.saturated;
            }
        });
        // How far an arrival went that left the map is unknown.
        for source in (0..own.stored.len()).filter(|&source| class(&record, &own.stored[source]) != EMPTY) {
            let moved = cells_moved(&record, &own.stored[source], rounding, self.frame);
            for (to, moved) in next.displacements[source].iter_mut().zip(moved) {
                *to = (*to + moved).clamp(-32768, 32767);
            }
        }
        self.layers[index] = next;
        saturated
    }

    /// Returns what is shown: the words of each cell and which layer they belong to.
    pub fn shown(&self) -> (Vec<Cell>, Vec<usize>) {
        let record = self.record();
        let layer = |cell: usize| {
            let there =
                (0..self.layers.len()).filter(|&layer| class(&record, &self.layers[layer].cells[cell]) != EMPTY);
            there.min_by_key(|&layer| (depth(&record, &self.layers[layer].cells[cell]), layer)).unwrap_or(0)
        };
        let layers: Vec<usize> = (0..self.shape.cells() as usize).map(layer).collect();
        (layers.iter().enumerate().map(|(cell, &layer)| self.layers[layer].cells[cell].clone()).collect(), layers)
    }

    /// Makes a frame; returns the counts.
    pub fn step(&mut self, settings: &Settings) -> Counts {
        let record = self.record();
        let columns = self.shape.columns() as usize;
        let surfaces = settings.fill_mode.uses_edges();
        let (before, _) = self.shown();
        self.before = self.layers[0].cells.clone();
        let mut tallies = Vec::new();
        for index in 0..self.layers.len() {
            let kind = self.layers[index].kind;
            if kind.stationary {
                let saturated = self.advance(index, settings.rounding);
                tallies.push(Tally { saturated, ..self.draw_layer(index) });
                continue;
            }
            let front = self.layers[index].cells.clone();
            let marked = edges(&record, &front, columns, settings.edge_threshold);
            let (mut cells, mut winners, mut tally) = self.moved(&front, settings.rounding);
            if surfaces && kind.edges {
                tally.edges = count(&marked);
            }
            if index == 0 {
                self.edges = marked;
            } else if surfaces && kind.edges && kind.winners {
                let holes = Holes {
                    record: &record,
                    columns,
                    fill_mode: FillMode::Bullet,
                    reach: settings.reach,
                    edges: Some(&marked),
                    winners_known: true,
                    foreign: &vec![false; front.len()],
                    before: None,
                };
                holes.fill(&mut cells, &mut winners, &mut tally);
            }
            (self.layers[index].cells, self.layers[index].winners) = (cells, winners);
            tallies.push(tally);
        }
        let (mut shown, layers) = self.shown();
        let foreign: Vec<bool> = layers.iter().map(|&layer| layer != 0).collect();
        let kind = self.layers[0].kind;
        let holes = Holes {
            record: &record,
            columns,
            fill_mode: settings.fill_mode,
            reach: settings.reach,
            edges: kind.edges.then_some(&self.edges),
            winners_known: kind.winners,
            foreign: &foreign,
            before: Some(&before),
        };
        let mut winners = std::mem::take(&mut self.layers[0].winners);
        holes.fill(&mut shown, &mut winners, &mut tallies[0]);
        self.layers[0].winners = winners;
        for (cell, words) in shown.into_iter().enumerate().filter(|&(cell, _)| !foreign[cell]) {
            self.layers[0].cells[cell] = words;
        }
        self.frame = self.frame.wrapping_add(1);
        let shown = (1..tallies.len()).map(|hidden| layers.iter().filter(|&&layer| layer == hidden).count() as u32);
        Counts { base: tallies[0], hidden: tallies[1..].to_vec(), shown: shown.collect() }
    }
}
