"""Check a folder of golden vectors (vectors.md) against the model: every hash, every file, every output, bit by bit.

    python3 check_vectors.py DIR [--require-all-rules]

Exit code 0: all agree. 1: something differs, or (with --require-all-rules) some rule was never reached. 2: the folder
cannot be read as vectors; one sentence on stderr says why.
"""

import argparse
import hashlib
import json
import sys
import zlib
from collections import Counter, namedtuple
from pathlib import Path

import galpix_model as model

SHOWN_OF_A_CASE = 5
SHOWN_DIFFERENCES = 40
WORD = 1 << 32


class Broken(Exception):
    """The folder does not hold what vectors.md says it holds."""


class Differences(list):
    """Sentences about what differs; counts all, keeps the first few of each case."""

    total = 0
    of_this_case = 0
    cases = 0

    def next_case(self):
        self.of_this_case = 0

    def add(self, sentence):
        self.total += 1
        self.cases += self.of_this_case == 0
        self.of_this_case += 1
        if self.of_this_case <= SHOWN_OF_A_CASE and len(self) < SHOWN_DIFFERENCES:
            self.append(sentence)


Checked = namedtuple("Checked", "frames numbers")   # frames of the case, and numbers that were compared


# --- Reading ---------------------------------------------------------------------------------------------------------

def read_bytes(path):
    try:
        return path.read_bytes()
    except OSError as error:
        raise Broken(f"{path} cannot be read: {error.strerror}") from error


def parse_json(data, path):
    try:
        return json.loads(data)
    except (ValueError, RecursionError) as error:
        raise Broken(f"{path} is not JSON: {error}") from error


def get(mapping, key, kind, where):
    """mapping[key], which must be of the type `kind`; bool is no int here."""
    if not isinstance(mapping, dict) or key not in mapping:
        raise Broken(f"{where}: {key!r} is missing")
    value = mapping[key]
    if not isinstance(value, kind) or (kind is int and isinstance(value, bool)):
        raise Broken(f"{where}: {key!r} is not of type {kind.__name__}")
    return value


def get_int(mapping, key, where, low=0, high=WORD - 1):
    value = get(mapping, key, int, where)
    if not low <= value <= high:
        raise Broken(f"{where}: {key!r} is {value}, not within {low} to {high}")
    return value


def get_words(mapping, key, where, length):
    value = get(mapping, key, list, where)
    if len(value) != length:
        raise Broken(f"{where}: {key!r} has {len(value)} words, not {length}")
    if not all(type(word) is int and 0 <= word < WORD for word in value):
        raise Broken(f"{where}: {key!r} holds something that is no 32-bit word")
    return value


def get_choice(mapping, key, choices, where):
    value = get(mapping, key, str, where)
    if value not in choices:
        raise Broken(f"{where}: {key!r} is {value!r}, none of {', '.join(choices)}")
    return value


def read_hex(data, path):
    """The words of a .hex file, the first of a number the most significant; lines that begin with // are comments."""
    words = []
    try:
        lines = data.decode("ascii").splitlines()
    except UnicodeDecodeError as error:
        raise Broken(f"{path} is not plain text") from error
    for number, line in enumerate(lines, 1):
        if line.startswith("//"):
            continue
        if not line or len(line) % 8 or not set(line) <= set("0123456789abcdefABCDEF"):
            raise Broken(f"{path}, line {number}: not 8 hexadecimal digits a word")
        words += [int(line[at:at + 8], 16) for at in range(0, len(line), 8)]
    return words


def read_component(entry, where):
    return model.Component(*(get_int(entry, name, where, 0, 64) for name in model.Component._fields))


def read_engine(case, where):
    """Budget, layout and grid of a case as the model's engine; widths that section 2 refuses are no vectors."""
    budget = get(case, "budget", dict, where)
    components = get(budget, "components", list, where)
    if len(components) != 3:
        raise Broken(f"{where}: the budget has {len(components)} components, not 3")
    numbers = (get_int(budget, name, where, 0, 64) for name in model.Budget._fields[1:])
    budget = model.Budget(tuple(read_component(entry, where) for entry in components), *numbers)
    entry = get(case, "layout", dict, where)
    layout = model.Layout(
        get_int(entry, "depth_bits", where), *(get(entry, field, bool, where) for field in
                                               ("velocity", "acceleration", "depth_motion", "luminosity")),
        get_int(entry, "tag_bits", where), get_choice(entry, "colour", model.FORMATS, where))
    grid = get(case, "grid", dict, where)
    grid = model.Grid(*(get_int(grid, name, where) for name in model.Grid._fields))
    return model.Engine(budget, layout, grid)


# --- Comparing -------------------------------------------------------------------------------------------------------

def compare_numbers(name, expected, got, where, differences):
    """Two lists of numbers, one difference for each place."""
    if len(expected) != len(got):
        differences.add(f"{where}: {name} has {len(expected)} numbers, expected by the model {len(got)}")
        return
    if expected == got:
        return
    for index, (mine, theirs) in enumerate(zip(expected, got)):
        if mine != theirs:
            differences.add(f"{where}, cell {index}, {name}: expected {mine}, got {theirs}")


def compare_map(name, expected, galpixels, engine, where, differences):
    """A map of the vectors and one of the model; the differences are reported field by field."""
    record, cells = engine.record, len(galpixels)
    got = model.pack_map(galpixels, record)
    if expected == got:
        return got
    for cell in range(cells):
        mine, theirs = expected[cell::cells], got[cell::cells]
        if mine == theirs:
            continue
        mine_fields, theirs_fields = model.unpack(mine, record), model.unpack(theirs, record)
        fields = [field for field in model.FIELDS if mine_fields[field] != theirs_fields[field]]
        for field in fields:
            differences.add(f"{where}, {name}, cell {cell}, {field}: expected {mine_fields[field]}, "
                            f"got {theirs_fields[field]}")
        if not fields:
            differences.add(f"{where}, {name}, cell {cell}, bits of no field: expected "
                            f"{' '.join(f'{word:08x}' for word in mine)}, "
                            f"got {' '.join(f'{word:08x}' for word in theirs)}")
    return got


def compare_counts(mapping, counts, where, differences):
    """All ten counts; those that a stage alone does not count are 0."""
    expected = get(mapping, "counts", dict, where)
    if set(expected) != set(model.COUNTS):
        differences.add(f"{where}: the counts are named {sorted(expected)}")
    for name in model.COUNTS:
        if expected.get(name) != counts.get(name, 0):
            differences.add(f"{where}, count {name}: expected {expected.get(name)}, got {counts.get(name, 0)}")


def compare_record(case, record, where, differences):
    """Section 4's result. Of an absent field only the bits are compared: the text gives it no place."""
    expected = get(case, "record", dict, where)
    if get_int(expected, "words", where) != record.words:
        differences.add(f"{where}: record of {expected['words']} words, got {record.words}")
    fields = get(expected, "fields", list, where)
    names = [get(entry, "name", str, where) for entry in fields]
    if names != list(model.FIELDS):
        differences.add(f"{where}: the fields of the record are {names}")
        return
    for entry, place in zip(fields, record.places):
        for part in ("bits", "word", "shift", "spill") if place.bits else ("bits",):
            if get_int(entry, part, where) != getattr(place, part):
                differences.add(f"{where}, record, {place.name}.{part}: expected {entry[part]}, "
                                f"got {getattr(place, part)}")


# --- The kinds -----------------------------------------------------------------------------------------------------
# Each returns (Checked, arrays that must stand in the .hex files by name).

def low_words(numbers):
    return [number % WORD for number in numbers]


def check_step(case, where, differences):
    component = read_component(get(case, "component", dict, where), where)
    rounding = get_choice(case, "rounding", model.ROUNDINGS, where)
    steps, results = get(case, "steps", list, where), get(case, "results", list, where)
    for rows, width in ((steps, 4), (results, 5)):
        if not all(isinstance(row, list) and len(row) == width and all(type(x) is int for x in row) for row in rows):
            raise Broken(f"{where}: a step or result is not a list of {width} integers")
    if len(steps) != len(results):
        raise Broken(f"{where}: {len(steps)} steps, but {len(results)} results")
    field = component.acceleration_int > 0
    model.check_component(component, field, component.position_frac, "the component")
    shifts = model.component_shifts(component, component.position_frac)
    bits = component.velocity_int + component.velocity_frac
    for index, ((n, r, v, a), expected) in enumerate(zip(steps, results)):
        thresh = model.threshold(rounding, shifts.down, n)
        r1, v1, clamped = model.step(r, v, a, shifts, thresh, bits, field)
        cells, offset = model.cells_moved(r1, component.position_frac)
        got = [r1, cells, offset, v1, abs(clamped)]
        if expected != got:
            for name, mine, theirs in zip(("position", "cells", "offset", "velocity", "saturated"), expected, got):
                if mine != theirs:
                    differences.add(f"{where}, step {index} {steps[index]}, {name}: expected {mine}, got {theirs}")
    arrays = {name: low_words(column) for name, column in
              zip(("frame", "r", "v", "a"), zip(*steps))} if steps else {}
    arrays.update({name: low_words(column) for name, column in
                   zip(("position", "cells", "offset", "velocity", "saturated"), zip(*results))} if results else {})
    return Checked(0, 5 * len(results)), arrays


def check_propagate(case, where, differences):
    engine = read_engine(case, where)
    record = engine.record
    compare_record(case, record, where, differences)
    rounding = get_choice(case, "rounding", model.ROUNDINGS, where)
    galpixels, results = get(case, "galpixels", list, where), get(case, "results", list, where)
    if len(galpixels) != len(results):
        raise Broken(f"{where}: {len(galpixels)} galpixels, but {len(results)} results")
    arrays = {name: [] for name in ("frame", "before", "after", "x_cells", "y_cells", "saturated")}
    for index, (given, expected) in enumerate(zip(galpixels, results)):
        here = f"{where}, galpixel {index}"
        n, before = get_int(given, "frame", here), get_words(given, "words", here, record.words)
        after = get_words(expected, "words", here, record.words)
        got, right, down, saturated = model.step_galpixel(engine, model.unpack(before, record),
                                                          model.thresholds_of(engine, rounding, n))
        cells = get(expected, "cells", list, here)
        compare_map("galpixel", after, [got], engine, here, differences)
        compare_numbers("cells", cells, [right, down], here, differences)
        compare_numbers("saturated", [get_int(expected, "saturated", here)], [saturated], here, differences)
        for name, words in (("frame", [n]), ("before", before), ("after", after), ("x_cells", low_words(cells[:1])),
                            ("y_cells", low_words(cells[1:])), ("saturated", [saturated])):
            arrays[name] += words
    return Checked(0, len(arrays["after"]) + 3 * len(results)), arrays


def check_resolve(case, where, differences):
    engine = read_engine(case, where)
    record, cells = engine.record, model.columns(engine.grid) * model.rows(engine.grid)
    compare_record(case, record, where, differences)
    arrivals, arrays = [], {"source": [], "cell": [], "arrivals": []}
    for entry in get(case, "arrivals", list, where):
        words = get_words(entry, "words", where, record.words)
        source = get_int(entry, "source", where)
        if "cell" not in entry:
            raise Broken(f"{where}: an arrival has no 'cell'")
        cell = None if entry["cell"] is None else get_int(entry, "cell", where, 0, cells - 1)
        arrivals.append(model.Arrival(source, cell, model.unpack(words, record)))
        arrays["source"].append(source)
        arrays["cell"].append(WORD - 1 if cell is None else cell)
        arrays["arrivals"] += words
    arrays["map"] = get_words(case, "map", where, record.words * cells)
    arrays["winners"] = get_words(case, "winners", where, cells)
    back, winners, counts = model.resolve(arrivals, cells)
    compare_map("map", arrays["map"], back, engine, where, differences)
    compare_numbers("winner", arrays["winners"], winners, where, differences)
    compare_counts(case, counts, where, differences)
    arrays["counts"] = count_words(case)
    return Checked(0, len(arrays["map"]) + cells + len(model.COUNTS)), arrays


def count_words(mapping):
    return [mapping["counts"][name] for name in model.COUNTS]


def check_edge(case, where, differences):
    engine = read_engine(case, where)
    record, cells = engine.record, model.columns(engine.grid) * model.rows(engine.grid)
    compare_record(case, record, where, differences)
    front = get_words(case, "front", where, record.words * cells)
    expected = get_words(case, "edges", where, -(-cells // 32))
    edges = model.edge_map(model.unpack_map(front, record, cells), engine.grid, get_int(case, "threshold", where))
    if expected != model.edge_words(edges):
        compare_numbers("edge bit", [int(bit) for bit in model.edge_bits(expected, cells)],
                        [int(bit) for bit in edges], where, differences)
        if expected[-1] >> ((cells - 1) % 32 + 1):
            differences.add(f"{where}: bits beyond the last cell of the edge map are set")
    compare_counts(case, {"edges": sum(edges)}, where, differences)
    return Checked(0, cells + len(model.COUNTS)), {"front": front, "edges": expected, "counts": count_words(case)}


def check_fill(case, where, differences):
    engine = read_engine(case, where)
    record, cells = engine.record, model.columns(engine.grid) * model.rows(engine.grid)
    compare_record(case, record, where, differences)
    fill_mode = get_choice(case, "rung", model.FILL_MODES, where)
    arrays = {name: get_words(case, name, where, record.words * cells) for name in ("front", "resolved", "map")}
    arrays.update({name: get_words(case, name, where, cells) for name in ("winners", "winners_after")})
    # fill modes that do not separate surfaces make no edge map; the text does not define what these words are for them
    length = -(-cells // 32) if model.separates_surfaces(fill_mode) or case.get("edges") else 0
    arrays["edges"] = get_words(case, "edges", where, length)
    edges = model.edge_bits(arrays["edges"], cells) if length else None
    galpixels, winners, counts = model.fill(
        engine, fill_mode, get_int(case, "reach", where), edges, model.unpack_map(arrays["front"], record, cells),
        model.unpack_map(arrays["resolved"], record, cells), arrays["winners"])
    compare_map("map", arrays["map"], galpixels, engine, where, differences)
    compare_numbers("winner after", arrays["winners_after"], winners, where, differences)
    compare_counts(case, counts, where, differences)
    arrays["counts"] = count_words(case)
    return Checked(0, len(arrays["map"]) + cells + len(model.COUNTS)), arrays


def stages_of(engine, before, rounding, edge_threshold, n):
    """What the stages of a frame give, as arrays: whatever the fill mode, with an edge map."""
    record, cells = engine.record, len(before)
    arrivals, _ = model.propagate(engine, before, rounding, n)
    resolved, winners, _ = model.resolve(arrivals, cells)
    return {
        "edges": model.edge_words(model.edge_map(before, engine.grid, edge_threshold)),
        "source": [arrival.source for arrival in arrivals],
        "cell": [WORD - 1 if arrival.cell is None else arrival.cell for arrival in arrivals],
        "arrivals": [word for arrival in arrivals for word in model.pack(arrival.galpixel, record)],
        "winners": winners,
        "resolved": model.pack_map(resolved, record),
    }


def check_frame(case, where, differences, manifest):
    engine = read_engine(case, where)
    record, cells = engine.record, model.columns(engine.grid) * model.rows(engine.grid)
    compare_record(case, record, where, differences)
    rounding = get_choice(case, "rounding", model.ROUNDINGS, where)
    fill_mode = get_choice(case, "rung", model.FILL_MODES, where)
    reach, edge_threshold = get_int(case, "reach", where), get_int(case, "threshold", where)
    n = get_int(case, "frame", where)
    arrays = {"front": get_words(case, "front", where, record.words * cells)}
    galpixels = model.unpack_map(arrays["front"], record, cells)
    frames = get(case, "frames", list, where)
    manifest_hashes, checksums = manifest
    arrays["counts"] = [word for entry in frames for word in count_words(entry)]
    arrays["crc32"] = checksums
    if len(checksums) != len(frames):
        differences.add(f"{where}: {len(frames)} frames, but {len(checksums)} checksums in the manifest")
    if len(frames) != len(manifest_hashes):
        differences.add(f"{where}: {len(frames)} frames, but {len(manifest_hashes)} hashes of frames in the manifest")
    numbers, optional = 0, {}
    for number, entry in enumerate(frames, 1):
        here = f"{where}, frame {number}"
        expected = arrays[f"map_{number}"] = get_words(entry, "map", here, record.words * cells)
        before, counter = galpixels, n
        galpixels, n, counts = model.frame(engine, galpixels, n, rounding, fill_mode, reach, edge_threshold)
        optional[number] = lambda before=before, counter=counter: stages_of(engine, before, rounding, edge_threshold,
                                                                           counter)
        got = compare_map("map", expected, galpixels, engine, here, differences)
        compare_counts(entry, counts, here, differences)
        digest = model.frame_hash(got)
        checksum = zlib.crc32(b"".join(word.to_bytes(4, "little") for word in got))
        if number <= len(checksums) and checksums[number - 1] != checksum:
            differences.add(f"{here}, CRC-32: expected {checksums[number - 1]}, got {checksum}")
        if get(entry, "sha256", str, here) != digest:
            differences.add(f"{here}, hash: expected {entry['sha256']}, got {digest}")
        if number <= len(manifest_hashes) and manifest_hashes[number - 1] != digest:
            differences.add(f"{here}, hash in the manifest: expected {manifest_hashes[number - 1]}, got {digest}")
        numbers += len(expected) + len(model.COUNTS) + 2
    return Checked(len(frames), numbers), Arrays(arrays, optional, record.words)


def check_inpaint(case, where, differences):
    engine = read_engine(case, where)
    record, cells = engine.record, model.columns(engine.grid) * model.rows(engine.grid)
    compare_record(case, record, where, differences)
    rounding = get_choice(case, "rounding", model.ROUNDINGS, where)
    reach, edge_threshold = get_int(case, "reach", where), get_int(case, "threshold", where)
    n = get_int(case, "frame", where)
    inpainting = model.Inpainting(get_choice(case, "gamma", model.GAMMAS, where),
                                  get_int(case, "inpaint_threshold", where), get(case, "motion", bool, where),
                                  get(case, "background", bool, where))
    arrays = {name: get_words(case, name, where, record.words * cells) for name in ("front", "after", "map")}
    # a frame without an edge map, and inpainting without a mask, have no words there; a mask may end early
    length = -(-cells // 32)
    arrays["edges"] = get_words(case, "edges", where, length if case.get("edges") else 0)
    arrays["mask"] = get_words(case, "mask", where, min(length, len(get(case, "mask", list, where))))
    before = model.unpack_map(arrays["front"], record, cells)
    edges = None
    if arrays["edges"]:
        edges = model.edge_map(before, engine.grid, edge_threshold)
        compare_numbers("edge word", arrays["edges"], model.edge_words(edges), where, differences)
    after, _, _ = model.frame(engine, before, n, rounding, "extend", reach, edge_threshold, edges is not None)
    compare_map("map after the frame", arrays["after"], after, engine, where, differences)
    thresholds = model.thresholds_of(engine, rounding, n)
    painted = model.inpaint(engine, inpainting, arrays["mask"] or None, before, edges, thresholds, after)
    compare_map("map", arrays["map"], painted, engine, where, differences)
    return Checked(0, 2 * len(arrays["map"]) + len(arrays["edges"])), arrays


def check_layers(case, where, differences):
    engine = read_engine(case, where)
    record, cells = engine.record, model.columns(engine.grid) * model.rows(engine.grid)
    compare_record(case, record, where, differences)
    rounding = get_choice(case, "rounding", model.ROUNDINGS, where)
    fill_mode = get_choice(case, "rung", model.FILL_MODES, where)
    reach, edge_threshold = get_int(case, "reach", where), get_int(case, "threshold", where)
    n = get_int(case, "frame", where)
    arrays, layers = {}, []
    for number, entry in enumerate(get(case, "layers", list, where)):
        here = f"{where}, layer {number}"
        words = arrays[f"map_{number}"] = get_words(entry, "map", here, record.words * cells)
        galpixels = model.unpack_map(words, record, cells)
        length = cells if get(entry, "anchored", bool, here) else 0
        places = arrays[f"displacements_{number}"] = get_words(entry, "displacements", here, length)
        stored = displacements = None
        if length:
            stored, displacements = galpixels, [model.displacement_of(word) for word in places]
            galpixels, _ = model.draw_stationary(engine, stored, displacements)
        layers.append(model.Layer(galpixels, stored, displacements, get(entry, "winners", bool, here),
                                  get(entry, "edges", bool, here)))
    numbers = 0

    def compare_shown(entry, key, here):
        nonlocal numbers
        shown = model.shown_layers(layers)
        expected = get_words(entry, "layers", here, cells)
        compare_numbers("layer of a cell", expected, shown, here, differences)
        words = get_words(entry, "map", here, record.words * cells)
        compare_map("map shown", words, model.shown_map(layers, shown), engine, here, differences)
        arrays[f"shown_{key}"], arrays[f"layers_{key}"] = words, expected
        numbers += len(words) + len(expected)

    compare_shown(get(case, "first", dict, where), 0, f"{where}, at first")
    for key, entry in enumerate(get(case, "frames", list, where), 1):
        here = f"{where}, frame {key}"
        layers, n, of, all_counts = model.frame_of_layers(engine, layers, n, rounding, fill_mode, reach, edge_threshold)
        compare_shown(entry, key, here)
        expected_counts = get(entry, "counts", list, here)
        if len(expected_counts) != len(layers):
            raise Broken(f"{here}: counts of {len(expected_counts)} layers, but there are {len(layers)}")
        for number, counts in enumerate(all_counts):
            compare_counts({"counts": expected_counts[number]}, counts, f"{here}, layer {number}", differences)
            numbers += len(model.COUNTS)
        shown = [of.count(number) for number in range(1, len(layers))]
        compare_numbers("cells that show a layer", get_words(entry, "shown", here, len(shown)), shown, here, differences)
        numbers += len(shown)
    after = get(case, "after", list, where)
    if len(after) != len(layers):
        raise Broken(f"{where}: {len(after)} layers after the frames, but there are {len(layers)}")
    for number, (entry, layer) in enumerate(zip(after, layers)):
        here = f"{where}, layer {number} after the frames"
        expected = arrays[f"own_{number}"] = get_words(entry, "map", here, record.words * cells)
        compare_map("map", expected, layer.own if layer.stored is None else layer.stored, engine, here, differences)
        places = [model.displacement_word(place) for place in layer.displacements or ()]
        expected = arrays[f"displacements_after_{number}"] = get_words(entry, "displacements", here, len(places))
        compare_numbers("displacement", expected, places, here, differences)
        numbers += len(arrays[f"own_{number}"]) + len(places)
    return Checked(len(case["frames"]), numbers), {name: words for name, words in arrays.items() if words}


def check_objects(case, where, differences):
    engine = read_engine(case, where)
    record, cells = engine.record, model.columns(engine.grid) * model.rows(engine.grid)
    compare_record(case, record, where, differences)
    rounding = get_choice(case, "rounding", model.ROUNDINGS, where)
    n = get_int(case, "frame", where)
    arrays = {"front": get_words(case, "front", where, record.words * cells)}
    galpixels = model.unpack_map(arrays["front"], record, cells)
    numbers = 0
    for number, entry in enumerate(get(case, "renderings", list, where), 1):
        here = f"{where}, rendering {number}"
        place, size = get_words(entry, "place", here, 2), get_words(entry, "size", here, 2)
        if place[0] + size[0] > model.columns(engine.grid) or place[1] + size[1] > model.rows(engine.grid):
            raise Broken(f"{here}: the rectangle is not within the map")
        words = arrays[f"galpixels_{number}"] = get_words(entry, "galpixels", here, record.words * size[0] * size[1])
        given = [model.unpack(words[at:at + record.words], record) for at in range(0, len(words), record.words)]
        rendering = model.Rendering(get_int(entry, "tag", here), get_int(entry, "stamp", here), place, size, given)
        galpixels, counts = model.enter_object(engine, galpixels, rendering, rounding, n)
        expected = arrays[f"map_{number}"] = get_words(entry, "map", here, record.words * cells)
        compare_map("map", expected, galpixels, engine, here, differences)
        expected = get(entry, "grafted", dict, here)
        compare_numbers("count", [get_int(expected, name, here) for name in model.GRAFTED],
                        [counts[name] for name in model.GRAFTED], here, differences)
        numbers += len(expected) + len(model.GRAFTED)
    return Checked(0, numbers), arrays


def check_disocclusion(case, where, differences):
    engine = read_engine(case, where)
    record, cells = engine.record, model.columns(engine.grid) * model.rows(engine.grid)
    compare_record(case, record, where, differences)
    reach = model.reach_of(get_int(case, "frames", where), get_int(case, "separation", where),
                           get_choice(case, "border", model.BORDERS, where), get(case, "tears", bool, where),
                           get(case, "through", bool, where))
    arrays = {"front": get_words(case, "front", where, record.words * cells)}
    arrays.update({name: get_words(case, name, where, cells) for name in ("marked", "spread")})
    arrays["mask"] = get_words(case, "mask", where, -(-cells // 32))
    marked, spread, mask, counts = model.disocclusion(engine, reach, model.unpack_map(arrays["front"], record, cells))
    for name, got in (("marked", marked), ("spread", spread), ("mask", mask)):
        compare_numbers(name, arrays[name], got, where, differences)
    expected = get(case, "counts", dict, where)
    if set(expected) != set(model.DISOCCLUSION_COUNTS):
        differences.add(f"{where}: the counts are named {sorted(expected)}")
    for name in model.DISOCCLUSION_COUNTS:
        if get_int(expected, name, where) != counts[name]:
            differences.add(f"{where}, count {name}: expected {expected[name]}, got {counts[name]}")
    return Checked(0, 2 * cells + len(mask) + len(counts)), arrays


def check_subcell(case, where, differences):
    engine = read_engine(case, where)
    record, cells = engine.record, model.columns(engine.grid) * model.rows(engine.grid)
    compare_record(case, record, where, differences)
    arrays = {"front": get_words(case, "front", where, record.words * cells),
              "shown": get_words(case, "shown", where, engine.grid.width * engine.grid.height)}
    front = model.unpack_map(arrays["front"], record, cells)
    shown = model.scan_out(engine, front, get_int(case, "threshold", where))
    compare_numbers("colour shown", arrays["shown"], shown, where, differences)
    return Checked(0, len(shown)), arrays


def read_source_inpainting(case, where, cells, arrays):
    """How the cells of a source without an entry are inpainted; None where they are not."""
    if "inpaint" not in case:
        return None
    where = f"{where}, inpaint"
    inpaint = get(case, "inpaint", dict, where)
    mask = get_words(inpaint, "mask", where, -(-cells // 32) if inpaint.get("mask") else 0)
    if mask:
        arrays["mask"] = mask
    texture = None
    if inpaint.get("texture") is not None:
        of = get(inpaint, "texture", dict, where)
        texture = model.Texture(get_int(of, "levels", where), get_choice(of, "noise", model.NOISE_FACTORS, where),
                                get(of, "coloured", bool, where), get_int(of, "seed", where))
    return model.SourceInpainting(get_choice(inpaint, "gamma", model.GAMMAS, where),
                                  get_int(inpaint, "threshold", where), mask or None, texture)


def read_layer_grid(entry, grid, where):
    """The grid of a layer of a source: that of the map, unless it has one of its own."""
    if "grid" not in entry:
        return model.Grid(model.columns(grid), model.rows(grid), 0, 0, 0, 0)
    own = get(entry, "grid", dict, where)
    return model.Grid(get_int(own, "width", where), get_int(own, "height", where), 0, 0, 0, 0)


def check_source(case, where, differences):
    engine = read_engine(case, where)
    record, cells = engine.record, model.columns(engine.grid) * model.rows(engine.grid)
    compare_record(case, record, where, differences)
    rounding = get_choice(case, "rounding", model.ROUNDINGS, where)
    fill_mode = get_choice(case, "fill_mode", ("none", "hold", "extend"), where)
    sub_cell, n = get(case, "sub_cell", bool, where), get_int(case, "frame", where)
    steps = get_int(case, "frames", where)
    arrays, maps = {}, []
    entries = get(case, "layers", list, where)
    for number, entry in enumerate(entries):
        here = f"{where}, layer {number}"
        grid = read_layer_grid(entry, engine.grid, here)
        own = model.columns(grid) * model.rows(grid)
        words = arrays[f"galpixels_{number}"] = get_words(entry, "galpixels", here, record.words * own)
        places = arrays[f"displacements_{number}"] = get_words(entry, "displacements", here, own)
        places = [tuple(model.displacement_of(word)) for word in places]
        maps.append((grid, model.unpack_map(words, record, own), places))
    sources = model.make_sources(engine, get_int(case, "threshold", where), maps)
    saturated = 0
    for _ in range(steps):
        sources, saturated = model.step_sources(sources, rounding, n)      # the counts are those of the last step
        n = (n + 1) % WORD
    inpainting = read_source_inpainting(case, where, cells, arrays)
    shown = model.show_sources(sources, fill_mode, sub_cell, inpainting)
    numbers = 0
    for number, (entry, layer) in enumerate(zip(entries, sources.layers)):
        here, own = f"{where}, layer {number}", len(layer.galpixels)
        links = arrays[f"links_{number}"] = get_words(entry, "links", here, own)
        compare_numbers("links", links, [model.link_number(of) for of in layer.links], here, differences)
        words = arrays[f"galpixels_after_{number}"] = get_words(entry, "galpixels_after", here, record.words * own)
        compare_map("map after the steps", words, layer.galpixels, engine, here, differences)
        places = arrays[f"displacements_after_{number}"] = get_words(entry, "displacements_after", here, own)
        compare_numbers("displacement after the steps", places,
                        [model.displacement_word(place) for place in layer.displacements], here, differences)
        numbers += len(words) + 2 * own
    got = {"keys": [model.entry_key(entry) for entry in shown.entries],
           "entries": [model.entry_word(entry) for entry in shown.entries], "gathered": shown.gathered}
    if sub_cell:
        got["shown"] = shown.colours
    if inpainting is not None:
        inpaint = case["inpaint"]
        known = model.edge_words(shown.picture.known)
        arrays["known"] = get_words(inpaint, "known", where, len(known))
        compare_numbers("word of known cells", arrays["known"], known, where, differences)
        for name, words in (("depths", shown.picture.depths),
                            ("moved", [model.displacement_word(place) for place in shown.picture.moved])):
            arrays[name] = get_words(inpaint, name, where, cells)
            compare_numbers(name, arrays[name], words, where, differences)
        numbers += len(known) + 2 * cells
    for name, words in got.items():
        arrays[name] = get_words(case, name, where, cells)
        compare_numbers(name, arrays[name], words, where, differences)
        numbers += cells
    compare_counts(case, {**shown.counts, "saturated": saturated}, where, differences)
    return Checked(steps, numbers + len(model.COUNTS)), arrays


CHECKS = {"step": check_step, "propagate": check_propagate, "resolve": check_resolve, "edge": check_edge,
          "fill": check_fill, "frame": check_frame, "inpaint": check_inpaint, "layers": check_layers, "objects": check_objects,
          "disocclusion": check_disocclusion, "subcell": check_subcell, "source": check_source}
COMPARED = {
    "step": "positions, cells, offsets, velocities, saturation",
    "propagate": "records, galpixels, cells, saturation",
    "resolve": "records, maps, winners, counts",
    "edge": "records, edges, counts",
    "fill": "records, maps, winners, counts",
    "frame": "records, maps, counts, hashes",
    "inpaint": "records, edges, maps before and after inpainting",
    "layers": "records, displacements, own and shown maps, layers shown, counts",
    "objects": "records, maps, counts",
    "disocclusion": "records, extents as marked and as spread, masks, counts",
    "subcell": "records, colours shown",
    "source": "records, links, galpixels and displacements after steps, entries, what is inpainted, colours gathered "
              "and shown, counts",
}


class Arrays(dict):
    """The arrays of a frame case, with those that stand in the folder only if they were asked for."""

    def __init__(self, arrays, stages, words):
        super().__init__(arrays)
        self.stages, self.words = stages, words

    def asked_for(self, name):
        """An array of a stage, or a map with a record a line; None if there is none of this name."""
        if name.endswith("_records"):
            planes = self.get(name.removesuffix("_records"))
            cells = len(planes) // self.words if planes else 0
            return planes and [planes[word * cells + cell] for cell in range(cells) for word in range(self.words)]
        array, _, number = name.rpartition("_")
        stages = self.stages.get(int(number)) if number.isdecimal() else None
        return stages().get(array) if stages else None


# --- The folder ------------------------------------------------------------------------------------------------------

def check_files(folder, entry, where, differences):
    """Hashes of all files of a case; returns their contents by path."""
    contents = {}
    for file in get(entry, "files", list, where):
        path = get(file, "path", str, where)
        if Path(path).is_absolute() or ".." in Path(path).parts:
            raise Broken(f"{where}: the path {path!r} leads out of the folder")
        contents[path] = read_bytes(folder / path)
        digest = hashlib.sha256(contents[path]).hexdigest()
        if get(file, "sha256", str, where) != digest:
            differences.add(f"{path}: SHA-256 expected {file['sha256']}, got {digest}")
    return contents


def check_hex(name, arrays, contents, differences):
    """The .hex files of a case carry exactly its arrays."""
    files = {path for path in contents if path.endswith(".hex")}
    for array, words in arrays.items():
        path = f"{name}/{array}.hex"
        if path not in files:
            differences.add(f"{path} is not in the manifest")
            continue
        files.remove(path)
        got = read_hex(contents[path], path)
        if got != words:
            place = next((i for i, (x, y) in enumerate(zip(got, words)) if x != y), min(len(got), len(words)))
            differences.add(f"{path} and case.json differ from word {place} on")
    for path in sorted(files):
        words = arrays.asked_for(Path(path).stem) if isinstance(arrays, Arrays) else None
        if words is None:
            differences.add(f"{path} is none of the arrays of the case")
        elif read_hex(contents[path], path) != words:
            differences.add(f"{path} is not what the model has")


def check_case(folder, entry, differences):
    """One case of the manifest: (kind, Checked)."""
    name = get(entry, "name", str, "manifest.json")
    where = f"case {name}"
    contents = check_files(folder, entry, where, differences)
    path = f"{name}/case.json"
    if path not in contents:
        raise Broken(f"{where}: {path} is not among its files")
    case = parse_json(contents[path], path)
    kind = get_choice(case, "kind", CHECKS, where)
    get(case, "about", str, where)
    if get(case, "name", str, where) != name or get(entry, "kind", str, where) != kind:
        differences.add(f"{where}: name or kind is not the one in the manifest")
    hashes = get(entry, "frames", list, where) if "frames" in entry else []
    try:
        if kind == "frame":
            checksums = get(entry, "crc32", list, where)
            checked, arrays = check_frame(case, where, differences, (hashes, checksums))
        else:
            if hashes:
                differences.add(f"{where}: hashes of frames in the manifest, but it is no frame case")
            checked, arrays = CHECKS[kind](case, where, differences)
    except model.Refused as error:
        raise Broken(f"{where}: refused by the specification: {error}") from error
    except (ArithmeticError, LookupError, TypeError, ValueError) as error:
        raise Broken(f"{where}: the model cannot work on it: {type(error).__name__}: {error}") from error
    check_hex(name, arrays, contents, differences)
    on_disc = {f"{name}/{file.name}" for file in (folder / name).iterdir()}
    for path in sorted(on_disc - set(contents)):
        differences.add(f"{path} is not in the manifest")
    return kind, checked


def check_folder(folder, differences):
    """All of the folder: for each kind the number of cases, of frames and of numbers compared."""
    if not folder.is_dir():
        raise Broken(f"{folder} is not a folder")
    manifest = parse_json(read_bytes(folder / "manifest.json"), folder / "manifest.json")
    if get(manifest, "format", str, "manifest.json") != "galpix-vectors-1":
        raise Broken(f"manifest.json: the format is {manifest['format']!r}, not 'galpix-vectors-1'")
    get_int(manifest, "seed", "manifest.json", 0, (1 << 64) - 1)
    parse_json(read_bytes(folder / "schema.json"), folder / "schema.json")
    cases, frames, numbers = Counter(), Counter(), Counter()
    for entry in get(manifest, "cases", list, "manifest.json"):
        differences.next_case()
        kind, checked = check_case(folder, entry, differences)
        cases[kind] += 1
        frames[kind] += checked.frames
        numbers[kind] += checked.numbers
    if not cases:
        raise Broken("manifest.json: there are no cases")
    return cases, frames, numbers


def main():
    parser = argparse.ArgumentParser(description="Check golden vectors against the model.")
    parser.add_argument("folder", type=Path, metavar="DIR")
    parser.add_argument("--require-all-rules", action="store_true",
                        help="fail if any rule that vectors can reach was never reached")
    arguments = parser.parse_args()
    differences = Differences()
    try:
        cases, frames, numbers = check_folder(arguments.folder, differences)
    except Broken as error:
        print(f"check_vectors.py: {error}", file=sys.stderr)
        return 2
    for kind in CHECKS:
        if cases[kind]:
            print(f"{kind}: {cases[kind]} cases{f', {frames[kind]} frames' if frames[kind] else ''}, "
                  f"{numbers[kind]} numbers compared ({COMPARED[kind]})")
    code = 0
    if differences:
        print(f"{differences.total} differences in {differences.cases} of {sum(cases.values())} cases"
              f"{', the first' if differences.total > len(differences) else ''}:")
        for sentence in differences:
            print(f"  {sentence}")
        code = 1
    if arguments.require_all_rules:
        never = [rule for rule in model.RULES if not model.reached[rule]]
        print(f"{len(model.RULES) - len(never)} of {len(model.RULES)} rules reached")
        for rule in never:
            print(f"  never reached: {rule}")
        code = 1 if never else code
    if not differences:
        print(f"{sum(cases.values())} cases, {sum(frames.values())} frames agree")
    return code


if __name__ == "__main__":
    sys.exit(main())
