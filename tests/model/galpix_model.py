"""A second implementation of the galpixmap, written from spec.md alone, to be read with it.

One section of the spec after another; the number of the section stands in each docstring. It is meant to be plain, not
quick. A galpixel is a dict of the 14 fields of section 3 (an absent field is there, and is 0); it is never changed in
place, so that a copy may share it. A map is a list of galpixels, one a cell.

Every rule of the text that is used is counted in `reached`, by its name in `RULES`; rules that no kind of vector file
can reach (derivation of a budget, loading, showing) are named in `RULES_BEYOND_VECTORS` instead.
"""

import hashlib
import struct
from collections import Counter, namedtuple
from fractions import Fraction
from itertools import combinations
from math import isqrt

reached = Counter()


class Refused(ValueError):
    """A budget, layout or grid that does not pass the checks of sections 2 and 6."""


# --- 1. Notation -----------------------------------------------------------------------------------------------------

COMPONENTS = ("x", "y", "depth")


def clamp(x, low, high):
    """Section 1."""
    return max(low, min(x, high))


def lowest(bits):
    """Section 1: the least value of a signed field of `bits` bits (0 for an absent one)."""
    return -(1 << bits - 1) if bits else 0


def highest(bits):
    """Section 1: the greatest value of a signed field of `bits` bits (0 for an absent one)."""
    return (1 << bits - 1) - 1 if bits else 0


def low_bits(x, bits):
    """Section 1: "the low n bits of x" in two's complement; Python's & works on that form."""
    return x & ((1 << bits) - 1)


def as_signed(x, bits):
    """Section 1: the signed number whose low `bits` bits are `x`."""
    return x - (1 << bits) if bits and x >> (bits - 1) else x


def ceil_log2(q):
    """Section 1: the smallest k, possibly negative, with 2^k >= q."""
    q = Fraction(q)
    k = 0
    while Fraction(2) ** k < q:
        k += 1
    while Fraction(2) ** (k - 1) >= q:
        k -= 1
    return k


# --- 2. Budget -------------------------------------------------------------------------------------------------------

Component = namedtuple("Component", "position_frac velocity_int velocity_frac acceleration_int acceleration_frac")
Budget = namedtuple("Budget", "components depth_int luminosity_int luminosity_frac")
Layout = namedtuple("Layout", "depth_bits velocity acceleration depth_motion luminosity tag_bits colour")


def derive_budget(d, recog, prop, acceleration):
    """Section 2: the table of widths, from the three design numbers (integers or Fractions)."""
    d, recog, prop = Fraction(d), Fraction(recog), Fraction(prop)
    if d <= 0 or recog <= 0 or prop < 2:
        reached["2 design numbers refused"] += 1
        raise Refused("D and recog must be positive, and prop at least 2")
    position_frac = ceil_log2(prop)
    if acceleration:
        reached["2 derived with acceleration"] += 1
        velocity_int = ceil_log2(d / recog) + 3
        acceleration_int = ceil_log2(d / recog ** 2) + 4
        acceleration_frac = ceil_log2(prop ** 2 / 2)
        velocity_frac = acceleration_frac
    else:
        reached["2 derived without acceleration"] += 1
        velocity_int = ceil_log2(d / recog) + 1
        acceleration_int = 0
        acceleration_frac = 0
        velocity_frac = position_frac
    if velocity_int < 1 or (acceleration and acceleration_int < 1):
        reached["2 derived width below 1 refused"] += 1
        raise Refused("a derived width of velocity_int or acceleration_int is below 1")
    component = Component(position_frac, velocity_int, velocity_frac, acceleration_int, acceleration_frac)
    luminosity_int = ceil_log2(256 / recog) + 1
    if luminosity_int < 1:
        reached["2 luminosity_int raised to 1"] += 1
        luminosity_int = 1
    return Budget((component,) * 3, ceil_log2(d), luminosity_int, position_frac)


def require(condition, sentence):
    """Section 2: one check."""
    if not condition:
        reached["2 budget or layout refused"] += 1
        raise Refused(sentence)


def check_component(component, acceleration, position_frac, name):
    """Section 2: the checks of one component; `position_frac` is its own, or for depth motion that of section 5."""
    c = component
    require(c.velocity_int >= 1, f"{name}: velocity_int below 1")
    require(c.acceleration_int >= (1 if acceleration else 0), f"{name}: acceleration_int too small")
    if acceleration:
        require(c.acceleration_frac <= c.velocity_frac, f"{name}: acceleration_frac > velocity_frac")
    require(c.position_frac <= 16, f"{name}: position_frac > 16")
    wider = max(c.velocity_int, c.acceleration_int)
    require(wider + c.velocity_frac + max(0, position_frac - c.velocity_frac - 1) <= 30, f"{name}: velocity too wide")
    require(c.velocity_frac + 2 - position_frac <= 30, f"{name}: too many dropped bits")


def check_layout(budget, layout):
    """Section 2: all checks of the components that the layout uses, and of the layout itself."""
    require(layout.colour in FORMATS, f"unknown colour format {layout.colour!r}")
    require(layout.velocity or not layout.acceleration, "acceleration needs velocity")
    require(not layout.depth_motion or (layout.depth_bits > 0 and layout.velocity),
            "depth motion needs depth and velocity")
    x, y, depth = budget.components
    if layout.velocity:
        check_component(x, layout.acceleration, x.position_frac, "x")
        check_component(y, layout.acceleration, y.position_frac, "y")
    widths = field_widths(budget, layout)
    require(widths["depth"] <= 28, "the depth field has more than 28 bits")
    if layout.depth_motion:
        require(widths["depth"] >= budget.depth_int, "the depth field has fewer bits than depth_int")
        check_component(depth, layout.acceleration, depth_position_frac(budget, layout), "depth")
    if layout.luminosity:
        require(budget.luminosity_int + budget.luminosity_frac <= 30, "luminosity too wide")
    require(sum(widths.values()) <= 256, "the fields together have more than 256 bits")
    for field in ("velocity", "acceleration", "depth_motion", "luminosity"):
        reached[f"3 {field} field" if getattr(layout, field) else f"3 no {field} field"] += 1
    reached["3 depth field" if layout.depth_bits else "3 no depth field"] += 1
    reached["3 tag field" if layout.tag_bits else "3 no tag field"] += 1
    reached[f"9 format {layout.colour}"] += 1


# --- 3. Fields -------------------------------------------------------------------------------------------------------

FIELDS = ("class", "depth", "offset_x", "offset_y", "velocity_x", "acceleration_x", "velocity_y", "acceleration_y",
          "velocity_depth", "acceleration_depth", "colour", "tag", "luminosity_rate", "luminosity")
SIGNED = frozenset(("offset_x", "offset_y", "velocity_x", "acceleration_x", "velocity_y", "acceleration_y",
                    "velocity_depth", "acceleration_depth", "luminosity_rate"))

GALPIXEL, JUST_UNOBSCURED, DEBRIS, EMPTY = range(4)


def field_widths(budget, layout):
    """Section 3: the bits of each field, 0 for an absent one."""
    widths = dict.fromkeys(FIELDS, 0)
    widths["class"] = 2
    widths["depth"] = layout.depth_bits + (budget.components[2].position_frac if layout.depth_motion else 0)
    for number, name in enumerate(COMPONENTS):
        component = budget.components[number]
        carried = layout.depth_motion if name == "depth" else layout.velocity
        if carried:
            if name != "depth":
                widths[f"offset_{name}"] = component.position_frac
            widths[f"velocity_{name}"] = component.velocity_int + component.velocity_frac
            if layout.acceleration:
                widths[f"acceleration_{name}"] = component.acceleration_int + component.acceleration_frac
    widths["colour"] = FORMATS[layout.colour].bits
    widths["tag"] = layout.tag_bits
    if layout.luminosity:
        widths["luminosity_rate"] = budget.luminosity_int + budget.luminosity_frac
        widths["luminosity"] = budget.luminosity_frac
    return widths


def empty_galpixel():
    """Section 3: class empty, every other field 0."""
    galpixel = dict.fromkeys(FIELDS, 0)
    galpixel["class"] = EMPTY
    return galpixel


# --- 4. Stored words -------------------------------------------------------------------------------------------------

Place = namedtuple("Place", "name bits word shift spill")
Record = namedtuple("Record", "words places")


def first_fit(widths, words):
    """Section 4, rule 1: the fields of each word, or None if some field finds no room within `words` words."""
    room = [32] * words
    fields_of_word = [[] for _ in range(words)]
    # sorted() is stable: fields of equal width stay in canonical order
    for name in sorted((name for name in FIELDS if widths[name]), key=lambda name: -widths[name]):
        for word in range(words):
            if room[word] >= widths[name]:
                room[word] -= widths[name]
                fields_of_word[word].append(name)
                break
        else:
            return None
    return fields_of_word


def make_record(widths):
    """Section 4: where each field is stored. Absent fields get a place of 0 bits at bit 0 of word 0."""
    # a place spans two words at most, and section 1 speaks of 32-bit words; the text has no check of it for the tag
    require(max(widths.values()) <= 32, "a field has more than 32 bits")
    total = sum(widths.values())
    words = -(-total // 32)
    places = {name: Place(name, 0, 0, 0, 0) for name in FIELDS}
    fields_of_word = first_fit(widths, words)
    if fields_of_word is not None:
        reached["4 first fit"] += 1
        for word, names in enumerate(fields_of_word):
            top = 32
            for name in sorted(names, key=FIELDS.index):
                top -= widths[name]
                places[name] = Place(name, widths[name], word, top, 0)
    else:
        reached["4 end to end"] += 1
        begin = 0
        for name in FIELDS:
            bits = widths[name]
            if bits == 0:
                continue
            word, used = divmod(begin, 32)
            spill = max(0, used + bits - 32)
            if spill:
                reached["4 field spills"] += 1
            places[name] = Place(name, bits, word, 32 - used - (bits - spill), spill)
            begin += bits
    return Record(words, tuple(places[name] for name in FIELDS))


def read_field(words, place):
    """Section 4: one field from the words of one galpixel."""
    value = low_bits(words[place.word] >> place.shift, place.bits - place.spill)
    if place.spill:
        value = value << place.spill | words[place.word + 1] >> (32 - place.spill)
    return as_signed(value, place.bits) if place.name in SIGNED else value


def write_field(words, place, value):
    """Section 4: one field into the words of one galpixel, which are 0 there before."""
    value = low_bits(value, place.bits)
    words[place.word] |= value >> place.spill << place.shift
    if place.spill:
        words[place.word + 1] |= low_bits(value, place.spill) << (32 - place.spill)


def unpack(words, record):
    """Section 4: a galpixel from its words."""
    return {place.name: read_field(words, place) if place.bits else 0 for place in record.places}


def pack(galpixel, record):
    """Section 4: the words of a galpixel; bits of no field are 0."""
    words = [0] * record.words
    for place in record.places:
        if place.bits:
            write_field(words, place, galpixel[place.name])
    return words


def unpack_map(words, record, cells):
    """Section 4: a map from its words, plane by plane: word k of cell c at k * cells + c."""
    return [unpack(words[c::cells], record) for c in range(cells)]


def pack_map(galpixels, record):
    """Section 4: the words of a map, plane by plane."""
    packed = [pack(galpixel, record) for galpixel in galpixels]
    return [words[k] for k in range(record.words) for words in packed]


# --- 5. Arithmetic of a component ------------------------------------------------------------------------------------

ROUNDINGS = ("truncate", "nearest", "low-discrepancy", "searched")

SEARCHED = {
    1: (1, 0),
    2: (2, 1, 2, 1),
    3: (6, 1, 3, 4, 3, 4, 6, 1),
    4: (0, 12, 15, 3, 11, 7, 4, 8, 8, 4, 7, 11, 3, 15, 12, 0),
    5: (26, 3, 12, 0, 21, 30, 16, 22, 18, 11, 3, 27, 13, 21, 7, 14, 9, 18, 27, 19, 5, 13, 31, 6, 1, 27, 20, 9, 29, 5,
        23, 4),
    6: (7, 30, 23, 7, 56, 14, 37, 58, 15, 50, 29, 16, 0, 56, 51, 60, 56, 11, 7, 24, 41, 55, 58, 36, 20, 4, 15, 63, 18,
        1, 33, 44, 31, 17, 53, 40, 25, 47, 10, 19, 44, 18, 63, 48, 34, 22, 18, 27, 23, 40, 39, 55, 10, 29, 26, 4, 62,
        26, 47, 32, 3, 37, 59, 12),
}

Shifts = namedtuple("Shifts", "acceleration_up down up")


def depth_position_frac(budget, layout):
    """Section 5: the fraction bits of a depth: what the depth field has below the bins of the depth range."""
    return max(0, field_widths(budget, layout)["depth"] - budget.depth_int)


def component_shifts(component, position_frac):
    """Section 5: acceleration_up, down and up."""
    return Shifts(max(0, component.velocity_frac - component.acceleration_frac),
                  max(0, component.velocity_frac + 1 - position_frac),
                  max(0, position_frac - component.velocity_frac - 1))


def reversed_bits(n, bits):
    """Section 5: the low `bits` bits of n in reverse order."""
    result = 0
    for bit in range(bits):
        result = result << 1 | (n >> bit & 1)
    return result


def threshold(rounding, down, n):
    """Section 5: the threshold of frame counter n for `down` dropped bits."""
    if down == 0:
        reached["5 threshold 0: no bits dropped"] += 1
        return 0
    if rounding == "truncate":
        reached["5 threshold truncate"] += 1
        return 0
    if rounding == "nearest":
        reached["5 threshold nearest"] += 1
        return 1 << (down - 1)
    if rounding == "low-discrepancy":
        reached["5 threshold low-discrepancy"] += 1
        return reversed_bits(n, down)
    if rounding != "searched":
        raise Refused(f"unknown rounding {rounding!r}")
    if down in SEARCHED:
        reached[f"5 threshold searched, down {down}"] += 1
        return SEARCHED[down][n % (1 << down)]
    reached["5 threshold searched, no table"] += 1
    return reversed_bits(n, down)


def step(r, v, a, shifts, thresh, velocity_bits, acceleration_lane):
    """Section 5, step: (r', v', saturated); saturated: the end at which the velocity was clamped (-1, 1), or 0."""
    if not acceleration_lane:
        reached["5 step without acceleration field"] += 1
        a = 0
    elif shifts.acceleration_up:
        reached["5 step, acceleration_up > 0"] += 1
    else:
        reached["5 step, acceleration_up 0"] += 1
    s = (v << 1) + (a << shifts.acceleration_up)
    r1 = r + (((s + thresh) >> shifts.down) << shifts.up)
    if shifts.down:
        reached["5 step, bits dropped"] += 1
        if (s + thresh) >> shifts.down != s >> shifts.down:
            reached[f"5 step, threshold rounds up, down {shifts.down if shifts.down in SEARCHED else 'more'}"] += 1
    elif shifts.up:
        reached["5 step, up > 0"] += 1
    else:
        reached["5 step, neither down nor up"] += 1
    if not acceleration_lane:
        return r1, v, 0
    w = v + (a << shifts.acceleration_up)
    v1 = clamp(w, lowest(velocity_bits), highest(velocity_bits))
    if v1 > w:
        reached["5 velocity clamped at the lowest"] += 1
        return r1, v1, -1
    if v1 < w:
        reached["5 velocity clamped at the highest"] += 1
        return r1, v1, 1
    return r1, v1, 0


def cells_moved(r1, position_frac):
    """Section 5: (cells, offset') of a position r'."""
    half = (1 << position_frac) >> 1
    cells = (r1 + half) >> position_frac
    offset = r1 - (cells << position_frac)
    if position_frac == 0:
        reached["5 cells, position_frac 0"] += 1
    elif offset == -half:
        reached["5 cells, half goes upwards"] += 1
    return cells, offset


def move_depth(r1, width):
    """Section 5: (depth', saturated) with depth motion."""
    if r1 < 0:
        reached["5 depth clamped at 0"] += 1
        return 0, 1
    if r1 > (1 << width) - 1:
        reached["5 depth clamped at all ones"] += 1
        return (1 << width) - 1, 1
    reached["5 depth moves freely"] += 1
    return r1, 0


def step_luminosity(luminosity, rate, colour, luminosity_frac, format_name):
    """Section 5: (luminosity', colour')."""
    level = luminosity + rate
    steps = level >> luminosity_frac
    reached["5 luminosity steps < 0" if steps < 0 else "5 luminosity steps > 0" if steps else
            "5 luminosity steps 0"] += 1
    form = FORMATS[format_name]
    channels = []
    for channel, bits in zip(split_channels(colour, format_name), form.channels):
        if steps and bits > form.narrowest:
            reached["5 luminosity, channel wider than L"] += 1
        wanted = channel + (steps << (bits - form.narrowest))
        channel = clamp(wanted, 0, (1 << bits) - 1)
        if channel > wanted:
            reached["5 luminosity, channel clamped at 0"] += 1
        elif channel < wanted:
            reached["5 luminosity, channel clamped at all ones"] += 1
        channels.append(channel)
    return low_bits(level, luminosity_frac), join_channels(channels, format_name)


def step_class(klass):
    """Section 5: class."""
    if klass == JUST_UNOBSCURED:
        reached["5 just unobscured becomes debris"] += 1
        return DEBRIS
    reached["5 class stays"] += 1
    return klass


class Engine:
    """What follows from budget, layout and grid, worked out once."""

    def __init__(self, budget, layout, grid):
        check_layout(budget, layout)
        check_grid(grid)
        self.budget, self.layout, self.grid = budget, layout, grid
        self.widths = field_widths(budget, layout)
        self.record = make_record(self.widths)
        x, y, depth = budget.components
        self.position_frac = (x.position_frac, y.position_frac, depth_position_frac(budget, layout))
        self.shifts = tuple(map(component_shifts, (x, y, depth), self.position_frac))


def step_galpixel(engine, before, thresholds):
    """Section 5: (galpixel after the step, cells of x, cells of y, number of fields that saturated)."""
    after = dict(before)
    layout = engine.layout
    saturated = 0
    moved = [0, 0]
    if layout.velocity:
        for number, name in enumerate(COMPONENTS):
            if name == "depth" and not layout.depth_motion:
                continue
            velocity, acceleration = f"velocity_{name}", f"acceleration_{name}"
            position = "depth" if name == "depth" else f"offset_{name}"
            r1, after[velocity], clamped = step(before[position], before[velocity], before[acceleration],
                                                engine.shifts[number], thresholds[number], engine.widths[velocity],
                                                layout.acceleration)
            if clamped:
                reached[f"5 {velocity} saturates at the {'lowest' if clamped < 0 else 'highest'}"] += 1
                saturated += 1
            if name == "depth":
                after["depth"], clamped = move_depth(r1, engine.widths["depth"])
                saturated += clamped
            else:
                moved[number], after[position] = cells_moved(r1, engine.position_frac[number])
    else:
        reached["5 without velocity stays in its cell"] += 1
    if layout.luminosity:
        after["luminosity"], after["colour"] = step_luminosity(
            before["luminosity"], before["luminosity_rate"], before["colour"], engine.budget.luminosity_frac,
            layout.colour)
    after["class"] = step_class(before["class"])
    return after, moved[0], moved[1], saturated


# --- 6. Grid ---------------------------------------------------------------------------------------------------------

Grid = namedtuple("Grid", "width height left right top bottom")


def columns(grid):
    """Section 6."""
    return grid.left + grid.width + grid.right


def rows(grid):
    """Section 6."""
    return grid.top + grid.height + grid.bottom


def check_grid(grid):
    """Section 6: the limits, taken for the sides of the display and for those of the map."""
    if min(grid) < 0 or min(grid.width, grid.height) < 1 or max(columns(grid), rows(grid)) > 32768 \
            or columns(grid) * rows(grid) > 1 << 28:
        reached["6 grid refused"] += 1
        raise Refused("a side of the grid is not 1 to 32768, or there are more than 2^28 cells")
    for side in ("left", "right", "top", "bottom"):
        reached[f"6 wing {side}" if getattr(grid, side) else f"6 no wing {side}"] += 1


def in_display(grid, column, row):
    """Section 6: whether a cell of the map is inside the overscan margin."""
    return 0 <= column - grid.left < grid.width and 0 <= row - grid.top < grid.height


# --- 7. Propagation and resolution -----------------------------------------------------------------------------------

NO_WINNER = (1 << 32) - 1

Arrival = namedtuple("Arrival", "source cell galpixel")     # cell is None if it is lost


def target_cell(grid, source, right, down):
    """Section 7: the cell `right` and `down` of the source, or None if that is outside of the map."""
    row, column = divmod(source, columns(grid))
    x, y = column + right, row + down
    inside_x, inside_y = 0 <= x < columns(grid), 0 <= y < rows(grid)
    if not (inside_x and inside_y):
        if not inside_x:
            reached["7 lost to the left" if x < 0 else "7 lost to the right"] += 1
        if not inside_y:
            reached["7 lost at the top" if y < 0 else "7 lost at the bottom"] += 1
        return None
    if in_display(grid, column, row) != in_display(grid, x, y):
        reached["7 out of a wing into the display" if in_display(grid, x, y) else
                "7 out of the display into a wing"] += 1
    if right:
        reached["7 moved left" if right < 0 else "7 moved right"] += 1
    if down:
        reached["7 moved up" if down < 0 else "7 moved down"] += 1
    if not right and not down:
        reached["7 stays in its cell"] += 1
    return y * columns(grid) + x


def thresholds_of(engine, rounding, n):
    """Section 5: the thresholds of a frame, one for each component."""
    # only for components that are carried, so that a rule counts as reached only where it has an effect
    carried = (engine.layout.velocity, engine.layout.velocity, engine.layout.depth_motion)
    return [threshold(rounding, shifts.down, n) if field else None for shifts, field in zip(engine.shifts, carried)]


def propagate(engine, front, rounding, n):
    """Section 7: (arrivals, number of fields that saturated)."""
    thresholds = thresholds_of(engine, rounding, n)
    arrivals = []
    saturated = 0
    for source, galpixel in enumerate(front):
        if galpixel["class"] == EMPTY:
            reached["7 empty sends nothing"] += 1
            continue
        after, right, down, fields = step_galpixel(engine, galpixel, thresholds)
        saturated += fields
        arrivals.append(Arrival(source, target_cell(engine.grid, source, right, down), after))
    return arrivals, saturated


def precedence(arrival):
    """Section 7: the order of arrivals at one cell."""
    return arrival.galpixel["class"], arrival.galpixel["depth"], arrival.source


def resolve(arrivals, cells):
    """Section 7: (back map, winners, counts of moved, lost, collided)."""
    best = [None] * cells
    lost = collided = 0
    for arrival in arrivals:
        if arrival.cell is None:
            lost += 1
            continue
        other = best[arrival.cell]
        if other is None:
            best[arrival.cell] = arrival
            continue
        collided += 1
        mine, theirs = precedence(arrival), precedence(other)
        level = "class" if mine[0] != theirs[0] else "depth" if mine[1] != theirs[1] else "source"
        reached[f"7 resolved by {level}"] += 1
        if mine < theirs:
            best[arrival.cell] = arrival
    back, winners = [], []
    for arrival in best:
        if arrival is None:
            reached["7 hole"] += 1
            back.append(empty_galpixel())
            winners.append(NO_WINNER)
        else:
            back.append(arrival.galpixel)
            winners.append(arrival.source)
    return back, winners, {"moved": len(arrivals), "lost": lost, "collided": collided}


# --- 8. Edge map -----------------------------------------------------------------------------------------------------

def neighbours(grid, cell):
    """Sections 8 and 10: the cells to the left, right, above and below; None outside of the map."""
    row, column = divmod(cell, columns(grid))
    return (cell - 1 if column > 0 else None,
            cell + 1 if column + 1 < columns(grid) else None,
            cell - columns(grid) if row > 0 else None,
            cell + columns(grid) if row + 1 < rows(grid) else None)


def is_edge(front, grid, cell, edge_threshold):
    """Section 8 (17): the bit of one cell."""
    reasons = []
    if front[cell]["class"] == EMPTY:
        reasons.append("own class")
    depth_sum = 0
    for side, neighbour in zip(("left", "right", "above", "below"), neighbours(grid, cell)):
        if neighbour is None:
            reached[f"8 nothing {side}: the cell itself"] += 1
            neighbour = cell
        elif front[neighbour]["class"] == EMPTY:
            reasons.append(f"class {side}")
        depth_sum += front[neighbour]["depth"]
    difference = depth_sum - 4 * front[cell]["depth"]
    if abs(difference) > edge_threshold:
        reasons.append("nearer than around it" if difference > 0 else "farther than around it")
    elif difference and abs(difference) == edge_threshold:
        reached["8 difference equal to the threshold"] += 1
    if not reasons:
        reached["8 no edge"] += 1
    elif len(reasons) == 1:
        reached[f"8 edge only by {reasons[0]}"] += 1
    else:
        reached["8 edge by several reasons"] += 1
    return bool(reasons)


def edge_map(front, grid, edge_threshold):
    """Section 8: one truth value a cell."""
    if edge_threshold > (1 << 31) - 1:
        reached["8 threshold above 2^31 - 1"] += 1
        edge_threshold = (1 << 31) - 1
    return [is_edge(front, grid, cell, edge_threshold) for cell in range(len(front))]


def edge_words(edges):
    """Section 8: cell c is bit c mod 32 of word c / 32; bits beyond the last cell are 0."""
    words = [0] * (-(-len(edges) // 32))
    for cell, edge in enumerate(edges):
        if edge:
            words[cell // 32] |= 1 << cell % 32
    if len(edges) % 32:
        reached["8 last word not full"] += 1
    return words


def edge_bits(words, cells):
    """Section 8: the inverse of `edge_words`."""
    return [bool(words[cell // 32] >> cell % 32 & 1) for cell in range(cells)]


def default_edge_threshold(depth_bits, only_faster=False):
    """Section 8: the default threshold for a depth field of `depth_bits` bits."""
    exponent = depth_bits - (7 if only_faster else 6)
    reached["8 default threshold a power of 2" if exponent >= 0 else "8 default threshold 1"] += 1
    return 1 << exponent if exponent >= 0 else 1


# --- 9. Colour -------------------------------------------------------------------------------------------------------

Format = namedtuple("Format", "bits channels narrowest")

FORMATS = {
    "rgb888": Format(24, (8, 8, 8), 8),
    "rgb565": Format(16, (5, 6, 5), 5),
    "gray8": Format(8, (8,), 8),
    "gray4": Format(4, (4,), 4),
}


def split_channels(colour, format_name):
    """Section 9: the channels, from the most significant bit."""
    channels = []
    shift = FORMATS[format_name].bits
    for bits in FORMATS[format_name].channels:
        shift -= bits
        channels.append(low_bits(colour >> shift, bits))
    return channels


def join_channels(channels, format_name):
    """Section 9: the inverse of `split_channels`."""
    colour = 0
    for channel, bits in zip(channels, FORMATS[format_name].channels):
        colour = colour << bits | channel
    return colour


def colour_from_rgb(red, green, blue, format_name):
    """Section 9: from 8-bit red, green, blue."""
    reached[f"9 from 8-bit to {format_name}"] += 1
    gray = (red + 2 * green + blue) >> 2
    channels = {"rgb888": (red, green, blue), "rgb565": (red >> 3, green >> 2, blue >> 3),
                "gray8": (gray,), "gray4": (gray >> 4,)}[format_name]
    return join_channels(channels, format_name)


def shown_rgb(colour, format_name):
    """Section 9: as 8-bit red, green, blue."""
    reached[f"9 shown from {format_name}"] += 1
    shown = []
    for channel, bits in zip(split_channels(colour, format_name), FORMATS[format_name].channels):
        # a channel of 8 bits stays; one of 4, 5 or 6 bits is continued by its own high bits
        shown.append(channel if bits == 8 else channel << (8 - bits) | channel >> (2 * bits - 8))
    return tuple(shown * 3 if len(shown) == 1 else shown)


# --- 10. Holes -------------------------------------------------------------------------------------------------------

FILL_MODES = ("none", "hold", "debris", "bullet", "galdebris", "extend")
FILLED = 1 << 31
HELD_CLASS = {"bullet": JUST_UNOBSCURED, "debris": DEBRIS}
MEAN_FIELDS = ("depth", "offset_x", "offset_y", "velocity_x", "acceleration_x", "velocity_y", "acceleration_y",
               "velocity_depth", "acceleration_depth", "luminosity_rate")


def separates_surfaces(fill_mode):
    """Section 10: the last three fill modes."""
    return fill_mode in ("bullet", "galdebris", "extend")


def rounds_of(fill_mode, reach):
    """Section 10: K."""
    if not separates_surfaces(fill_mode):
        reached["10 K = 1 for the fill mode"] += 1
        return 1
    reached["10 reach below 1" if reach < 1 else "10 reach above 16" if reach > 16 else "10 reach as it is"] += 1
    return clamp(reach, 1, 16)


def is_inside(back, winners, edges, place, k, foreign=()):
    """Section 10: "inside a surface" in round k; a place outside of the map is None. Section 16: no foreign cell is."""
    if place is None:
        reached["10 not inside: outside of the map"] += 1
        return False
    if place in foreign:
        reached["16 not inside: foreign"] += 1
        return False
    winner = winners[place]
    if edges is None:
        reached["11 not inside: no edge map"] += 1
        return False
    if winner < FILLED:
        how = "10 not inside: edge" if edges[winner] else "10 inside: no edge"
        reached[how if back[place]["class"] == GALPIXEL else f"{how}, class {back[place]['class']}"] += 1
        return not edges[winner]
    if winner < FILLED + k:
        reached["10 inside: filled in an earlier round"] += 1
        return True
    reached["10 not inside: hole"] += 1
    return False


def is_vacant(winners, place, k, foreign=()):
    """Section 10: "vacant" in round k. Section 16: no foreign cell is."""
    if place is None:
        reached["10 vacant: outside of the map"] += 1
        return True
    if place in foreign:
        reached["16 not vacant: foreign"] += 1
        return False
    if winners[place] >= FILLED + k:
        reached["10 vacant: hole"] += 1
        return True
    reached["10 not vacant"] += 1
    return False


def corners(grid, cell):
    """Section 10: the cells at the upper left, lower right, upper right, lower left; None outside of the map."""
    row, column = divmod(cell, columns(grid))

    def at(right, down):
        if 0 <= column + right < columns(grid) and 0 <= row + down < rows(grid):
            return cell + down * columns(grid) + right
        return None

    return at(-1, -1), at(1, 1), at(1, -1), at(-1, 1)


def mean_number(numbers):
    """Section 10: the mean of two or of four numbers, halves upwards."""
    if len(numbers) == 2:
        if sum(numbers) % 2:
            reached["10 mean of two, odd sum" if sum(numbers) > 0 else "10 mean of two, odd negative sum"] += 1
        return (sum(numbers) + 1) >> 1
    if sum(numbers) % 4 == 2:
        reached["10 mean of four, half"] += 1
    elif sum(numbers) % 4:
        reached["10 mean of four, a quarter up or down"] += 1
    return (sum(numbers) + 2) >> 2


def mean(galpixels, format_name):
    """Section 10: field by field; tag and luminosity are those of the first."""
    result = dict(galpixels[0])
    for name in MEAN_FIELDS:
        result[name] = mean_number([galpixel[name] for galpixel in galpixels])
    channels = zip(*(split_channels(galpixel["colour"], format_name) for galpixel in galpixels))
    result["colour"] = join_channels([mean_number(values) for values in channels], format_name)
    return result


def bullet_hole(engine, back, winners, edges, cell, k, foreign=()):
    """Section 10: the bullet of a bullet hole, or None if the cell is none."""
    result = bullet_of(engine, back, winners, edges, cell, k, foreign)
    return result and {**result, "class": DEBRIS}


def bullet_of(engine, back, winners, edges, cell, k, foreign):
    """Section 10: what a bullet hole takes, but for the class; None if the cell is none."""
    places = neighbours(engine.grid, cell)
    inside = [back[place] if is_inside(back, winners, edges, place, k, foreign) else None for place in places]
    where = "sides"
    if inside == [None] * 4:
        if not all([is_vacant(winners, place, k, foreign) for place in places]):
            reached["10 sides, case 5: none, some not vacant"] += 1
            return None
        where = "corners"
        inside = [back[place] if is_inside(back, winners, edges, place, k, foreign) else None
                  for place in corners(engine.grid, cell)]
    letters = "abcd"
    there = "".join(letter for letter, galpixel in zip(letters, inside) if galpixel is not None)
    a, b, c, d = inside
    form = engine.layout.colour
    if there == "abcd":
        reached[f"10 {where}, case 1: all four"] += 1
        return mean([a, b, c, d], form)
    if a is not None and b is not None:
        reached[f"10 {where}, case 2: {there}"] += 1
        return mean([a, b], form)
    if c is not None and d is not None:
        reached[f"10 {where}, case 2: {there}"] += 1
        return mean([c, d], form)
    if len(there) == 2:
        reached[f"10 {where}, case 3: {there}"] += 1
        return mean([a if a is not None else b, c if c is not None else d], form)
    if len(there) == 1:
        reached[f"10 {where}, case 4: {there}"] += 1
        return inside[letters.index(there)]
    reached[f"10 {where}, case 5: none"] += 1
    return None


def nearest_not_empty(back, grid, cell, direction):
    """Section 10, extend: the nearest cell to the left (-1) or right (1) in the same row that is not empty, or None."""
    row, column = divmod(cell, columns(grid))
    column += direction
    while 0 <= column < columns(grid):
        if back[row * columns(grid) + column]["class"] != EMPTY:
            return back[row * columns(grid) + column]
        column += direction
    return None


def extended(back, grid, cell, before):
    """Section 10, extend, known."""
    left = nearest_not_empty(back, grid, cell, -1)
    right = nearest_not_empty(back, grid, cell, 1)
    if left is not None and right is not None:
        if left["depth"] == right["depth"]:
            reached["10 extend: equal depths, left"] += 1
            chosen = left
        elif left["depth"] > right["depth"]:
            reached["10 extend: left is farther"] += 1
            chosen = left
        else:
            reached["10 extend: right is farther"] += 1
            chosen = right
    elif left is not None:
        reached["10 extend: only left"] += 1
        chosen = left
    elif right is not None:
        reached["10 extend: only right"] += 1
        chosen = right
    else:
        reached["10 extend: row empty, before"] += 1
        chosen = before
    return {**chosen, "class": JUST_UNOBSCURED}


def last_resort(engine, fill_mode, back, cell, before):
    """Section 10, last round: (galpixel, name of its count) of a hole that is no bullet hole."""
    result = empty_galpixel()
    if fill_mode == "none":
        reached["10 fill mode none"] += 1
        return result, "empty"
    known = before["class"] != EMPTY
    if fill_mode == "hold" or not known:
        reached[f"10 fill mode {fill_mode}, {'known' if known else 'not known'}"
                + (f", class {before['class']}" if known else "")] += 1
        result["colour"] = before["colour"]
        return result, "empty"
    reached[f"10 fill mode {fill_mode}, known, class {before['class']}"] += 1
    if fill_mode == "extend":
        return extended(back, engine.grid, cell, before), "galdebris"
    if fill_mode == "galdebris":
        return {**before, "class": JUST_UNOBSCURED}, "galdebris"
    result["colour"] = before["colour"]
    result["class"] = HELD_CLASS[fill_mode]
    result["depth"] = (1 << engine.widths["depth"]) - 1
    return result, "debris"


def fill(engine, fill_mode, reach, edges, front, resolved, resolved_winners, foreign=()):
    """Section 10: (map, winners, counts of holes and of what they became). `edges`: one truth value a cell, or None.

    Section 16: `foreign` cells are no holes, and others may be left as holes.
    """
    back, winners = list(resolved), list(resolved_winners)
    holes = [cell for cell, winner in enumerate(winners) if winner == NO_WINNER and cell not in foreign]
    counts = {"holes": len(holes), "bullets": 0, "debris": 0, "galdebris": 0, "empty": 0}
    rounds = rounds_of(fill_mode, reach)
    for k in range(rounds):
        decisions = []
        for cell in holes:
            galpixel = None
            if separates_surfaces(fill_mode):
                galpixel = bullet_hole(engine, back, winners, edges, cell, k, foreign)
            if galpixel is not None:
                reached["10 bullet hole in round 0" if k == 0 else "10 bullet hole in a later round"] += 1
                if k == rounds - 1:
                    reached["10 bullet hole in the last round"] += 1
                decisions.append((cell, galpixel, FILLED + k))
                counts["bullets"] += 1
            elif k == rounds - 1:
                galpixel, name = last_resort(engine, fill_mode, back, cell, front[cell])
                decisions.append((cell, galpixel, NO_WINNER))
                counts[name] += 1
            else:
                reached["10 hole left for the next round"] += 1
        for cell, galpixel, winner in decisions:
            back[cell], winners[cell] = galpixel, winner
        decided = {cell for cell, _, _ in decisions}
        holes = [cell for cell in holes if cell not in decided]
    return back, winners, counts


# --- 11. A frame -----------------------------------------------------------------------------------------------------

COUNTS = ("moved", "lost", "collided", "saturated", "edges", "holes", "bullets", "debris", "galdebris", "empty")


def frame(engine, front, n, rounding, fill_mode, reach, edge_threshold, with_edges=True):
    """Section 11: (next front map, next frame counter, counts)."""
    counts = dict.fromkeys(COUNTS, 0)
    edges = None
    if separates_surfaces(fill_mode) and with_edges:
        reached["11 edge map made"] += 1
        edges = edge_map(front, engine.grid, edge_threshold)
        counts["edges"] = sum(edges)
    else:
        reached["11 no edge map"] += 1
    arrivals, counts["saturated"] = propagate(engine, front, rounding, n)
    back, winners, resolved_counts = resolve(arrivals, len(front))
    counts.update(resolved_counts)
    back, winners, fill_counts = fill(engine, fill_mode, reach, edges, front, back, winners)
    counts.update(fill_counts)
    if n == (1 << 32) - 1:
        reached["11 frame counter wraps"] += 1
    return back, (n + 1) % (1 << 32), counts


def frame_hash(words):
    """vectors.md: SHA-256 of the words of a map, each as 4 bytes, the least significant first."""
    return hashlib.sha256(struct.pack(f"<{len(words)}I", *words)).hexdigest()


# --- 12. Loading an update -------------------------------------------------------------------------------------------

def load_value(x, frac, low, high):
    """Section 12: (field, whether it was clamped) of an exact value x (int or Fraction)."""
    scaled = Fraction(x) * Fraction(2) ** frac + Fraction(1, 2)
    wanted = scaled.numerator // scaled.denominator
    field = clamp(wanted, low, high)
    reached["12 loaded as it is" if field == wanted else
            "12 clamped at the lowest" if field > wanted else "12 clamped at the highest"] += 1
    return field, field != wanted


def load_fraction_bits(engine, name):
    """Section 12: the fraction bits of a field."""
    budget, layout = engine.budget, engine.layout
    if name == "depth":
        return engine.widths["depth"]
    if name == "luminosity_rate":
        return budget.luminosity_frac - (8 - FORMATS[layout.colour].narrowest)
    field, component_name = name.split("_")
    number = COMPONENTS.index(component_name)
    component = budget.components[number]
    if field == "offset":
        return component.position_frac
    frac = component.velocity_frac if field == "velocity" else component.acceleration_frac
    if component_name == "depth":
        frac += engine.widths["depth"] - engine.position_frac[2]
    return frac


def load_update(engine, values, red, green, blue, tag):
    """Section 12: (galpixel of class 0, number of values counted as clamped). `values`: exact values by field name."""
    galpixel = dict.fromkeys(FIELDS, 0)
    counted = 0
    for name, x in values.items():
        bits = engine.widths[name]
        if bits == 0:
            reached["12 absent field forgets"] += 1
            continue
        low, high = (lowest(bits), highest(bits)) if name in SIGNED else (0, (1 << bits) - 1)
        galpixel[name], clamped = load_value(x, load_fraction_bits(engine, name), low, high)
        if clamped and name not in ("depth", "offset_x", "offset_y"):
            reached["12 clamped and counted"] += 1
            counted += 1
    galpixel["colour"] = colour_from_rgb(red, green, blue, engine.layout.colour)
    galpixel["tag"] = low_bits(tag, engine.widths["tag"])
    return galpixel, counted


# --- 14. Inpainting by push-pull -------------------------------------------------------------------------------------

GAMMAS = ("0", "1/2", "1")
SAMPLED = ("own", "column beside", "row beside", "both beside")
Inpainting = namedtuple("Inpainting", "gamma threshold motion background")
Node = namedtuple("Node", "validity depth values source")   # of a cell of a level; the last two None for validity 0
Stored = namedtuple("Stored", "columns rows nodes")         # a level


def is_masked(mask, cell):
    """Section 14: whether the bit of a cell is set; beyond the end of a mask no bit is."""
    if cell // 32 >= len(mask):
        reached["14 mask ends before the cell"] += 1
        return False
    return bool(mask[cell // 32] >> cell % 32 & 1)


def is_hole(galpixel, mask, cell):
    """Section 14: class 1 and, where there is a mask, its bit set."""
    if mask is None:
        reached["14 no mask"] += 1
        return galpixel["class"] == JUST_UNOBSCURED
    masked = is_masked(mask, cell)
    if galpixel["class"] != JUST_UNOBSCURED:
        if masked:
            reached["14 bit of a cell of another class"] += 1
        return False
    reached["14 class 1, bit set" if masked else "14 class 1, bit not set"] += 1
    return masked


def in_hull(corners_at, column, row):
    """Section 14: whether a place is in the convex hull of four places, border included.

    A point of the hull of points in a plane is in a triangle of three of them, which may be a line or a point.
    """
    def side(a, b):
        return (b[0] - a[0]) * (row - a[1]) - (b[1] - a[1]) * (column - a[0])

    inside, on_side = False, False
    for a, b, c in combinations(corners_at, 3):
        box = all(min(p) <= q <= max(p) for p, q in zip(zip(a, b, c), (column, row)))
        sides = side(a, b), side(b, c), side(c, a)
        if box and (min(sides) >= 0 or max(sides) <= 0):
            inside = True
            on_side = on_side or 0 in sides
    if inside:
        reached["14 hull: on a line between corners" if on_side else "14 hull: between all lines"] += 1
    else:
        reached["14 hull: in the box alone"] += 1
    return inside


def is_line(places):
    """Section 14, for coverage alone: whether all places are on one line."""
    return all((b[0] - a[0]) * (c[1] - a[1]) == (b[1] - a[1]) * (c[0] - a[0]) for a, b, c in combinations(places, 3))


def is_quad(before, grid, edges, quad):
    """Section 14: whether four cells of the map before the frame are the corners of a quad."""
    if edges is None:
        reached["14 quad without an edge map"] += 1
    elif not any(edges[cell] for cell in quad):
        reached["14 no quad: no edge"] += 1
        return False
    if any(before[cell]["class"] == EMPTY for cell in quad):
        reached["14 no quad: a corner is empty"] += 1
        return False
    if edges is not None:
        marked = [bool(edges[cell]) for cell in quad]
        reached[f"14 quad, edge at corner {marked.index(True)} alone" if sum(marked) == 1 else
                "14 quad, several edges"] += 1
    return True


def deepen(engine, before, edges, thresholds, after):
    """Section 14, depth of the background: the map after the frame with the holes' depths raised."""
    grid = engine.grid
    after = list(after)
    width = columns(grid)
    for y in range(rows(grid) - 1):
        for x in range(1, width):
            quad = [row * width + column for column in (x - 1, x) for row in (y, y + 1)]
            if not is_quad(before, grid, edges, quad):
                continue
            places, deepest = [], 0
            for cell in quad:
                stepped, right, down, _ = step_galpixel(engine, before[cell], thresholds)
                places.append((cell % width + right, cell // width + down))
                deepest = max(deepest, stepped["depth"])
            left, right = min(p[0] for p in places), max(p[0] for p in places)
            top, bottom = min(p[1] for p in places), max(p[1] for p in places)
            w, h = right - left, bottom - top
            if w < 2 and h < 2:
                reached["14 quad not stretched"] += 1
                continue
            if w > 64 or h > 64:
                reached["14 quad torn: columns" if h <= 64 else "14 quad torn: rows" if w <= 64 else
                        "14 quad torn: both"] += 1
                if max(w, h) == 65:
                    reached["14 quad torn: just so"] += 1
                continue
            reached["14 quad stretched: both" if w >= 2 and h >= 2 else
                    "14 quad stretched: columns" if w >= 2 else "14 quad stretched: rows"] += 1
            if max(w, h) == 64:
                reached["14 quad stretched: just so"] += 1
            if is_line(places):
                reached["14 quad is a line"] += 1
            if left < 0 or right >= width or top < 0 or bottom >= rows(grid):
                reached["14 quad with a corner outside of the map"] += 1
            for row in range(max(top, 0), min(bottom, rows(grid) - 1) + 1):
                for column in range(max(left, 0), min(right, width - 1) + 1):
                    cell = row * width + column
                    hole = after[cell]
                    if hole["class"] != JUST_UNOBSCURED or not in_hull(places, column, row):
                        continue
                    if hole["depth"] >= deepest:
                        reached["14 hole as deep as its quad"] += 1
                        continue
                    reached["14 hole deepened"] += 1
                    after[cell] = {**hole, "depth": deepest}
    return after


def weighted_mean(values, weights, sources, tie):
    """Section 14: `mean` of each channel of `values`, and its source."""
    s = sum(weights)
    means = []
    for channel in zip(*values):
        n = sum(weight * value for weight, value in zip(weights, channel))
        if 2 * (n % s) == s:
            reached[f"14 mean, half, tie {tie}"] += 1
        means.append((n + (s - 1 + tie) // 2) // s)
    largest = max(weights)
    if len({source for source, weight in zip(sources, weights) if weight == largest}) > 1:
        reached["14 source: first of several"] += 1
    return tuple(means), sources[weights.index(largest)]


def tie_at(x, y, k):
    """Section 14."""
    return (x ^ y ^ k) & 1


def level_0(engine, galpixels, down):
    """Section 14, levels: level 0."""
    form = FORMATS[engine.layout.colour]
    nodes = []
    for cell, galpixel in enumerate(galpixels):
        klass = galpixel["class"]
        reached[f"14 level 0, class {klass}"] += 1
        if klass == EMPTY and galpixel["depth"] >> down:
            reached["14 depth of class 3 is 0"] += 1
        depth = 0 if klass == EMPTY else galpixel["depth"] >> down
        channels = split_channels(galpixel["colour"], engine.layout.colour)
        values = tuple(c << (10 - bits) for c, bits in zip(channels, form.channels))
        nodes.append(Node(16, depth, values, cell) if klass in (GALPIXEL, DEBRIS) else Node(0, depth, None, None))
    return Stored(columns(engine.grid), rows(engine.grid), nodes)


def validity_of(gamma, total):
    """Section 14, pull: the validity for S > 0."""
    if gamma == "0":
        reached["14 gamma 0"] += 1
        return 16
    if gamma == "1/2":
        reached["14 gamma 1/2"] += 1
        # the nearest to sqrt(4 S): m or m + 1; a square of m + 1/2 is no whole number, so that there is no half
        root = isqrt(4 * total)
        if 4 * total > root * root + root:
            reached["14 gamma 1/2, rounds up"] += 1
            root += 1
        return max(1, root)
    if total + 2 >> 2 < 1:
        reached["14 gamma 1, at least 1"] += 1
    reached["14 gamma 1"] += 1
    return max(1, total + 2 >> 2)


def pull(fine, k, gamma, limit):
    """Section 14, pull: level k from level k - 1."""
    wide, high = fine.columns + 1 >> 1, fine.rows + 1 >> 1
    nodes = []
    for y in range(high):
        for x in range(wide):
            below = [fine.nodes[row * fine.columns + column] for row in (2 * y, 2 * y + 1)
                     for column in (2 * x, 2 * x + 1) if column < fine.columns and row < fine.rows]
            if len(below) < 4:
                reached["14 pull, one cell" if len(below) == 1 else
                        "14 pull, one row" if 2 * y + 1 == fine.rows else "14 pull, one column"] += 1
            depth = max(node.depth for node in below)
            weights = []
            for node in below:
                if node.validity and node.depth != depth:
                    reached["14 pull: nearer, counts with 0" if depth - node.depth > limit else
                            "14 pull: nearer by the threshold" if depth - node.depth == limit else
                            "14 pull: nearer by less"] += 1
                weights.append(0 if depth - node.depth > limit else node.validity)
            total = sum(weights)
            if total == 0:
                reached["14 pull: nothing counts" if any(node.validity for node in below) else
                        "14 pull: nothing there"] += 1
                nodes.append(Node(0, depth, None, None))
                continue
            counted = [(node, weight) for node, weight in zip(below, weights) if weight]
            values, source = weighted_mean([node.values for node, _ in counted], [weight for _, weight in counted],
                                           [node.source for node, _ in counted], tie_at(x, y, k))
            nodes.append(Node(validity_of(gamma, total), depth, values, source))
    return Stored(wide, high, nodes)


def sample(coarse, x, y, depth, k, limit):
    """Section 14, push: (values, source) of the sample for cell (x, y) of level k, or None."""
    column, row = x >> 1, y >> 1
    beside_x = column + 1 if x & 1 else column - 1
    beside_y = row + 1 if y & 1 else row - 1
    nodes, weights, there = [], [], []
    four = (column, row), (beside_x, row), (column, beside_y), (beside_x, beside_y)
    for (cx, cy), weight, name in zip(four, (9, 3, 3, 1), SAMPLED):
        if not (0 <= cx < coarse.columns and 0 <= cy < coarse.rows):
            reached["14 sample: cell does not exist"] += 1
            continue
        node = coarse.nodes[cy * coarse.columns + cx]
        if node.validity == 0:
            reached["14 sample: validity 0"] += 1
            continue
        if depth - node.depth > limit:
            reached["14 sample: nearer"] += 1
            continue
        if node.depth < depth and depth - node.depth == limit:
            reached["14 sample: nearer by the threshold"] += 1
        nodes.append(node)
        weights.append(weight)
        there.append(name)
    if not nodes:
        return None
    reached[f"14 sample of {', '.join(there)}"] += 1
    return weighted_mean([node.values for node in nodes], weights, [node.source for node in nodes], tie_at(x, y, k))


def push(fine, coarse, k, limit):
    """Section 14, push: level k, which is not level 0, from level k + 1."""
    nodes = []
    for index, node in enumerate(fine.nodes):
        y, x = divmod(index, fine.columns)
        if node.validity == 16:
            reached["14 push: full validity stays"] += 1
            nodes.append(node)
            continue
        taken = sample(coarse, x, y, node.depth, k, limit)
        if taken is None:
            reached["14 push: no sample, nothing" if node.validity == 0 else "14 push: no sample, stays"] += 1
            nodes.append(node)
            continue
        values, source = taken
        if node.validity:
            reached["14 push: mean, of itself most" if node.validity > 8 else
                    "14 push: mean, halves" if node.validity == 8 else "14 push: mean, of the sample most"] += 1
            values, source = weighted_mean([node.values, values], [node.validity, 16 - node.validity],
                                           [node.source, source], tie_at(x, y, k))
        else:
            reached["14 push: takes the sample"] += 1
        nodes.append(Node(16, node.depth, values, source))
    return Stored(fine.columns, fine.rows, nodes)


def inpaint(engine, inpainting, mask, before, edges, thresholds, after):
    """Section 14: the map after a frame of fill mode extend, inpainted.

    `before`: the map before the frame, `edges`: its edge map or None; `thresholds`: of the frame, of each component.
    """
    width = engine.widths["depth"]
    down = max(0, width - 25)
    reached["14 down > 0" if down else "14 down 0" if width else "14 no depth field"] += 1
    if inpainting.background:
        reached["14 depth of the background"] += 1
        after = deepen(engine, before, edges, thresholds, after)
    else:
        reached["14 no depth of the background"] += 1
    levels = [level_0(engine, after, down)]
    while len(levels[-1].nodes) > 1:
        levels.append(pull(levels[-1], len(levels), inpainting.gamma, inpainting.threshold))
    # from the level below the last down to level 1; level 0 has only its holes pushed, in the loop after this one
    for k in range(len(levels) - 2, 0, -1):
        levels[k] = push(levels[k], levels[k + 1], k, inpainting.threshold)
    result = list(after)
    form = FORMATS[engine.layout.colour]
    for cell, galpixel in enumerate(after):
        if not is_hole(galpixel, mask, cell):
            continue
        if len(levels) == 1:
            reached["14 map of one cell"] += 1
            continue
        row, column = divmod(cell, columns(engine.grid))
        taken = sample(levels[1], column, row, levels[0].nodes[cell].depth, 0, inpainting.threshold)
        if taken is None:
            reached["14 hole without a sample"] += 1
            continue
        values, source = taken
        channels = [(c + (1 << (9 - bits))) >> (10 - bits) for c, bits in zip(values, form.channels)]
        result[cell] = dict(after[source]) if inpainting.motion else dict(galpixel)
        reached["14 hole takes colour and motion" if inpainting.motion else "14 hole takes colour alone"] += 1
        result[cell]["class"] = galpixel["class"]
        result[cell]["depth"] = galpixel["depth"]
        result[cell]["colour"] = join_channels(channels, engine.layout.colour)
    return result


# --- 15. Metamers ----------------------------------------------------------------------------------------------------

MOST_LEVELS = 8
NOISE_FACTORS = {"deviation": 55147, "interval": 13148}
TONE_LIMIT = 1020
MOMENTS = 12        # of each of the six bands E and Q

Texture = namedtuple("Texture", "levels noise coloured seed")
# A picture of sections 14 and 15: of each cell the channels, whether it is known, whether it is to be filled, its depth
# and its movement (x, y).
Picture = namedtuple("Picture", "columns rows channels known holes depths moved")


def smooth(a, b, c, d, e):
    """Section 15, responses."""
    return a + 4 * b + 22 * c + 4 * d + e


def sharp(a, b, c, d, e):
    """Section 15, responses."""
    return 10 * c - a - 4 * b - 4 * d - e


def bands(p):
    """Section 15, responses: (K_x, K_y) of five rows of five numbers."""
    smoothed = [smooth(*(p[j][i] for j in range(5))) + 16 >> 5 for i in range(5)]
    sharpened = [sharp(*(p[j][i] for j in range(5))) + 16 >> 5 for i in range(5)]
    return sharp(*smoothed) + 2 >> 2, smooth(*sharpened) + 2 >> 2


def tone_of(colour, format_name):
    """Section 15, tones: of a stored colour."""
    red, green, blue = shown_rgb(colour, format_name)
    return red + 2 * green + blue - 510, 4 * (blue - green), 4 * (red - green)


def colour_of_tone(tone, format_name):
    """Section 15, holes: the stored colour of a tone."""
    y, cb, cr = tone
    g = y + 510 - (cb + cr + 2 >> 2)
    levels = []
    bits = FORMATS[format_name].channels
    for q, b in zip((g + cr, g, g + cb), bits if len(bits) == 3 else bits * 3):
        level = q + 2 >> 2
        if not 0 <= level <= 255:
            reached["15 level clamped"] += 1
        level = clamp(level, 0, 255)
        levels.append(level - (level >> b) + ((1 << (8 - b)) >> 1))
    return colour_from_rgb(*levels, format_name)


def statistics_of(tones, gamma, limit):
    """Section 15, responses and moments: level 1 of the moments of a level of tones, with mu and sigma as values."""
    nodes = []
    for cell, node in enumerate(tones.nodes):
        y, x = divmod(cell, tones.columns)
        window = [[tones.nodes[clamp(y + j, 0, tones.rows - 1) * tones.columns + clamp(x + i, 0, tones.columns - 1)]
                   for i in range(-2, 3)] for j in range(-2, 3)]
        cells = [of for row in window for of in row]
        depths = [of.depth for of in cells]
        if min(of.validity for of in cells) < 16:
            reached["15 response not known: validity"] += 1
        elif max(depths) - min(depths) > limit:
            reached["15 response not known: depth"] += 1
        else:
            reached["15 response known"] += 1
            found = [response for channel in range(3)
                     for response in bands([[of.values[channel] for of in row] for row in window])]
            nodes.append(Node(16, node.depth, tuple(found + [x * x for x in found]), cell))
            continue
        nodes.append(Node(0, node.depth, None, None))
    levels = [Stored(tones.columns, tones.rows, nodes)]
    while len(levels[-1].nodes) > 1:
        levels.append(pull(levels[-1], len(levels), gamma, limit))
    for k in range(len(levels) - 2, 0, -1):
        levels[k] = push(levels[k], levels[k + 1], k, limit)
    return levels[1]._replace(nodes=[node if node.validity == 0 else node._replace(values=mu_and_sigma(node.values))
                                     for node in levels[1].nodes])


def mu_and_sigma(moments):
    """Section 15, moments: mu of all bands, then sigma of all bands."""
    means, squares = moments[:MOMENTS // 2], moments[MOMENTS // 2:]
    deviations = []
    for e, q in zip(means, squares):
        variance = max(0, q - e * e)
        root = isqrt(variance)
        deviations.append(root + 1 if variance > root * root + root else root)
    return (*means, *deviations)


def white(x, y, k, seed):
    """Section 15, noise: of the three channels at a place."""
    modulus = 1 << 32
    h = (0x9E3779B1 * x + 0x85EBCA77 * y + 0xC2B2AE3D * k + 0x27D4EB2F * seed) % modulus
    h = 0x7FEB352D * (h ^ h >> 16) % modulus
    h = 0x846CA68B * (h ^ h >> 15) % modulus
    h ^= h >> 16
    return [8 * (h >> 8 * c & 255) - 1020 for c in range(3)]


def noise_from(place, moved, k):
    """Section 15, where the noise is taken: in column or row, before modulo 2^32."""
    half = 1 << k >> 1
    return place - (min(moved + half, (1 << 31) - 1) >> k)


def detailed(tone, x, y, k, moved, statistics, texture):
    """Section 15, sum: a tone of level k with the level's detail."""
    column, row = noise_from(x, moved[0], k), noise_from(y, moved[1], k)
    field = [[white(column + i, row + j, k, texture.seed) for i in range(-2, 3)] for j in range(-2, 3)]
    result = []
    for channel, start in enumerate(tone):
        noisy = channel == 0 or texture.coloured
        total = 0
        responses = bands([[place[channel] for place in line] for line in field])
        for band, response in enumerate(responses):
            mu, sigma = statistics[2 * channel + band], statistics[MOMENTS // 2 + 2 * channel + band]
            xi = response * NOISE_FACTORS[texture.noise] + (1 << 15) >> 16
            total += (sigma * xi if noisy else 0) + (mu << 10)
        value = start + (total + (1 << 11) >> 12)
        if abs(value) > TONE_LIMIT:
            reached["15 channel clamped"] += 1
        result.append(clamp(value, -TONE_LIMIT, TONE_LIMIT))
    reached[f"15 detail, {'moved' if any(moved) else 'not moved'}"] += 1
    return tuple(result)


def metamers(engine, inpainting, texture, picture):
    """Section 15: the colours of the holes of a picture, by cell."""
    name, limit, gamma = engine.layout.colour, inpainting.threshold, inpainting.gamma
    nodes = [Node(16, depth, tone_of(join_channels(channels, name), name), cell) if known else
             Node(0, depth, None, None)
             for cell, (channels, known, depth) in enumerate(zip(picture.channels, picture.known, picture.depths))]
    levels = [Stored(picture.columns, picture.rows, nodes)]
    while len(levels[-1].nodes) > 1:
        levels.append(pull(levels[-1], len(levels), gamma, limit))
    top = len(levels) - 1
    last = min(clamp(texture.levels, 1, MOST_LEVELS), top)
    reached["15 a single cell" if last == 0 else "15 L is top" if last == top else "15 L below top"] += 1
    if last == 0:
        return {}
    reached[f"15 noise by {texture.noise}{', coloured' if texture.coloured else ''}"] += 1
    statistics = [statistics_of(levels[k], gamma, limit) for k in range(last)]
    for k in range(top - 1, last - 1, -1):
        levels[k] = push(levels[k], levels[k + 1], k, limit)

    def taken(x, y, depth, k):
        """What a cell of level k takes: (tone, source), or None."""
        found = sample(levels[k + 1], x, y, depth, k, limit)
        if found is None:
            reached["15 no sample of tones"] += 1
            return None
        tone, source = found
        of_level = sample(statistics[k], x, y, depth, 0, limit)
        if of_level is None:
            reached["15 no sample of statistics"] += 1
            return found
        return detailed(tone, x, y, k, picture.moved[source], of_level[0], texture), source

    for k in range(last - 1, 0, -1):
        result = []
        for cell, node in enumerate(levels[k].nodes):
            y, x = divmod(cell, levels[k].columns)
            found = taken(x, y, node.depth, k) if node.validity < 16 else None
            if found is not None:
                tone, source = found
                if node.validity:
                    reached["15 cell takes a mean"] += 1
                    tone, source = weighted_mean([node.values, tone], [node.validity, 16 - node.validity],
                                                 [node.source, source], tie_at(x, y, k))
                else:
                    reached["15 cell takes the sum"] += 1
                node = Node(16, node.depth, tone, source)
            result.append(node)
        levels[k] = levels[k]._replace(nodes=result)
    filled = {}
    for cell in range(len(nodes)):
        if picture.holes[cell]:
            y, x = divmod(cell, picture.columns)
            found = taken(x, y, nodes[cell].depth, 0)
            if found is not None:
                filled[cell] = colour_of_tone(found[0], name)
    return filled


def push_pull_picture(engine, inpainting, picture):
    """Section 14: the colours of the holes of a picture, by cell."""
    form, limit = FORMATS[engine.layout.colour], inpainting.threshold
    nodes = [Node(16, depth, tuple(c << (10 - bits) for c, bits in zip(channels, form.channels)), cell) if known else
             Node(0, depth, None, None)
             for cell, (channels, known, depth) in enumerate(zip(picture.channels, picture.known, picture.depths))]
    levels = [Stored(picture.columns, picture.rows, nodes)]
    while len(levels[-1].nodes) > 1:
        levels.append(pull(levels[-1], len(levels), inpainting.gamma, limit))
    for k in range(len(levels) - 2, 0, -1):
        levels[k] = push(levels[k], levels[k + 1], k, limit)
    filled = {}
    for cell in range(len(nodes)):
        if picture.holes[cell] and len(levels) > 1:
            y, x = divmod(cell, picture.columns)
            found = sample(levels[1], x, y, nodes[cell].depth, 0, limit)
            if found is not None:
                channels = [(c + (1 << (9 - bits))) >> (10 - bits) for c, bits in zip(found[0], form.channels)]
                filled[cell] = join_channels(channels, engine.layout.colour)
    return filled


# --- 16. Layers ------------------------------------------------------------------------------------------------------

Layer = namedtuple("Layer", "own stored displacements has_winners has_edges")
"""A layer: its own galpixels, one per cell; if it is a stationary-source layer what is stored, and [dx, dy] per cell."""


def displacement_of(word):
    """Section 16: [dx, dy] of the word of a displacement."""
    return [as_signed(low_bits(word, 16), 16), as_signed(word >> 16, 16)]


def displacement_word(place):
    """Section 16: the word of [dx, dy]."""
    return low_bits(place[0], 16) | low_bits(place[1], 16) << 16


def shown_layers(layers):
    """Section 16: for each cell the number of the layer that is shown."""
    numbers = []
    for cell in range(len(layers[0].own)):
        there = [(layer.own[cell]["depth"], number)
                 for number, layer in enumerate(layers) if layer.own[cell]["class"] != EMPTY]
        if not there:
            reached["16 shown: nothing, the base's cell"] += 1
            numbers.append(0)
            continue
        there.sort()
        if len(there) > 1:
            reached["16 shown by depth" if there[0][0] != there[1][0] else "16 shown by layer"] += 1
        number = there[0][1]
        reached["16 shown: another layer" if number else "16 shown: the base"] += 1
        if number and layers[0].own[cell]["class"] == EMPTY:
            reached["16 shown: where the base has nothing"] += 1
        if any(layers[other].own[cell]["class"] < layers[number].own[cell]["class"] for _, other in there):
            reached["16 shown: what was filled, before a galpixel"] += 1
        numbers.append(number)
    return numbers


def shown_map(layers, numbers):
    """Section 16: what is shown."""
    return [layers[number].own[cell] for cell, number in enumerate(numbers)]


def draw_stationary(engine, stored, displacements):
    """Section 16: (drawn map, counts) of a stationary-source layer."""
    arrivals = []
    for source, galpixel in enumerate(stored):
        if galpixel["class"] != EMPTY:
            right, down = displacements[source]
            arrivals.append(Arrival(source, target_cell(engine.grid, source, right, down), galpixel))
    drawn, _, counts = resolve(arrivals, len(stored))
    if counts["lost"]:
        reached["16 stationary-source: lost, but stored"] += 1
    if counts["collided"]:
        reached["16 stationary-source: discarded, but stored"] += 1
    return drawn, counts


def step_stationary(engine, layer, thresholds):
    """Section 16: (layer, counts) of a stationary-source layer one frame later."""
    stored, displacements, saturated = [], [], 0
    for galpixel, place in zip(layer.stored, layer.displacements):
        if galpixel["class"] == EMPTY:
            stored.append(galpixel)
            displacements.append(place)
            continue
        after, right, down, fields = step_galpixel(engine, galpixel, thresholds)
        saturated += fields
        stored.append(after)
        moved = [place[0] + right, place[1] + down]
        clamped = [clamp(cells, -32768, 32767) for cells in moved]
        if clamped != moved:
            reached["16 stationary-source: displacement clamped"] += 1
        displacements.append(clamped)
    drawn, counts = draw_stationary(engine, stored, displacements)
    return layer._replace(own=drawn, stored=stored, displacements=displacements), {**counts, "saturated": saturated}


def step_layer(engine, layer, n, rounding, fill_mode, reach, edge_threshold, is_base):
    """Section 16, steps 2 and 3: (new own map, winners, edges or None, counts) of a layer whose galpixels move."""
    counts = dict.fromkeys(COUNTS, 0)
    edges = None
    if separates_surfaces(fill_mode) and layer.has_edges:
        edges = edge_map(layer.own, engine.grid, edge_threshold)
        counts["edges"] = sum(edges)
    arrivals, counts["saturated"] = propagate(engine, layer.own, rounding, n)
    own, winners, resolved_counts = resolve(arrivals, len(layer.own))
    counts.update(resolved_counts)
    if not is_base and edges is not None and layer.has_winners:
        for k in range(rounds_of(fill_mode, reach)):
            holes = [cell for cell, winner in enumerate(winners) if winner == NO_WINNER]
            filled = [(cell, bullet_hole(engine, own, winners, edges, cell, k)) for cell in holes]
            for cell, galpixel in filled:
                if galpixel is None:
                    reached["16 hole stays in its layer"] += 1
                else:
                    reached["16 bullet hole in another layer"] += 1
                    own[cell], winners[cell] = galpixel, FILLED + k
                    counts["holes"] += 1
                    counts["bullets"] += 1
    elif not is_base:
        reached["16 layer whose holes all stay"] += 1
    return own, winners, edges, counts


def frame_of_layers(engine, layers, n, rounding, fill_mode, reach, edge_threshold):
    """Section 16: (layers, next frame counter, numbers of the layers shown, counts a layer) one frame later."""
    before = shown_map(layers, shown_layers(layers))
    thresholds = thresholds_of(engine, rounding, n)
    moved, all_counts = [], []
    base_winners = base_edges = None
    for number, layer in enumerate(layers):
        counts = dict.fromkeys(COUNTS, 0)
        if layer.stored is not None:
            layer, drawn_counts = step_stationary(engine, layer, thresholds)
            counts.update(drawn_counts)
        else:
            own, winners, edges, counts = step_layer(engine, layer, n, rounding, fill_mode, reach, edge_threshold,
                                                     number == 0)
            layer = layer._replace(own=own)
            if number == 0:
                base_winners, base_edges = winners, edges
        moved.append(layer)
        all_counts.append(counts)
    numbers = shown_layers(moved)
    foreign = frozenset(cell for cell, number in enumerate(numbers) if number)
    if any(base_winners[cell] == NO_WINNER for cell in foreign):
        reached["16 hole of the base under another layer"] += 1
    filled, _, fill_counts = fill(engine, fill_mode, reach, base_edges, before, shown_map(moved, numbers), base_winners,
                                  foreign)
    all_counts[0].update(fill_counts)
    own = [moved[0].own[cell] if cell in foreign else filled[cell] for cell in range(len(filled))]
    moved[0] = moved[0]._replace(own=own)
    return moved, (n + 1) % (1 << 32), numbers, all_counts


# --- 17. Disocclusion map --------------------------------------------------------------------------------------------

Reach = namedtuple("Reach", "frames separation border tears through")
Body = namedtuple("Body", "key motion")             # motion: of x and of y (offset, v, A)

BORDERS = ("still", "continues")
DISOCCLUSION_COUNTS = ("edges", "endless", "covered")

LEFT, RIGHT, ABOVE, BELOW = range(4)
SIDES = ("left", "right", "above", "below")
OPPOSITE = (RIGHT, LEFT, BELOW, ABOVE)
SATURATED = 127
BEYOND = Body((1 << 31) - 1, ((0, 0, 0),) * 2)


def reach_of(frames, separation, border, tears, through):
    """Section 17: settings, with what is too large brought into range."""
    if frames > 255:
        reached["17 frames above 255"] += 1
        frames = 255
    if separation > 1 << 30:
        reached["17 separation above 2^30"] += 1
        separation = 1 << 30
    reached[f"17 border {border}"] += 1
    reached["17 tears count" if tears else "17 tears do not count"] += 1
    reached["17 surfaces let through" if through else "17 surfaces not let through"] += 1
    return Reach(frames, separation, border, tears, through)


def default_reach(engine, frames):
    """Section 17: what the settings are by default."""
    bits = engine.widths["depth"]
    reached["17 default with a depth" if bits else "17 default without a depth"] += 1
    return Reach(frames, default_edge_threshold(bits) if bits else 0, "still", True, False)


def body_of(engine, galpixel):
    """Section 17, bodies."""
    if galpixel["class"] == EMPTY:
        reached["17 body of class 3"] += 1
        return BEYOND
    reached[f"17 body of class {galpixel['class']}"] += 1
    key = (galpixel["class"] << engine.widths["depth"]) + galpixel["depth"]
    return Body(key, tuple((galpixel[f"offset_{name}"], galpixel[f"velocity_{name}"],
                            galpixel[f"acceleration_{name}"] << engine.shifts[number].acceleration_up)
                           for number, name in enumerate(COMPONENTS[:2])))


def steps_ahead(engine, number, v, big_a, frames):
    """Section 17, ahead: `2v + A` of each of the steps."""
    bits = engine.widths[f"velocity_{COMPONENTS[number]}"]
    steps = []
    for _ in range(frames):
        steps.append(2 * v + big_a)
        if engine.layout.acceleration:
            w = clamp(v + big_a, lowest(bits), highest(bits))
            if w != v + big_a:
                reached["17 velocity clamped at the highest" if w < v + big_a else "17 velocity clamped at the lowest"] += 1
            v = w
    return steps


def ahead(engine, reach, number, one, other):
    """Section 17, ahead: (cells by which `one` gets ahead of `other` along a component, whether they part)."""
    if reach.frames == 0:
        reached["17 no frames"] += 1
        return 0, False
    (offset, v, big_a), (offset2, v2, big_a2) = one.motion[number], other.motion[number]
    if one.motion[number] == other.motion[number]:
        reached["17 equal motion"] += 1
        return 0, False
    shifts = engine.shifts[number]
    if engine.layout.acceleration:
        slack = (1 << shifts.down) - 1
        reached["17 slack with acceleration" if slack else "17 slack 0 with acceleration"] += 1
    else:
        slack = max(0, (1 << shifts.down) - 2)
        reached["17 slack without acceleration" if slack else "17 slack 0 without acceleration"] += 1
    sums, total = [], 0
    for s, s2 in zip(steps_ahead(engine, number, v, big_a, reach.frames),
                     steps_ahead(engine, number, v2, big_a2, reach.frames)):
        total += s - s2
        sums.append(total)
    with_slack = [total + n * slack for n, total in enumerate(sums, 1)]
    largest = max(with_slack)
    if largest > with_slack[0] and largest > with_slack[-1]:
        reached["17 farthest ahead on the way"] += 1
    elif len(sums) > 1:
        reached["17 farthest ahead at last" if largest > with_slack[0] else "17 farthest ahead at first"] += 1
    reached["17 ahead, up > 0" if shifts.up else "17 ahead, up 0"] += 1
    part = 1 << engine.budget.components[number].velocity_frac + 1
    if max(sums) == part:
        reached["17 part just so"] += 1
    elif 0 < max(sums) < part:
        reached["17 do not part"] += 1
    units = offset - offset2 + ((largest >> shifts.down) << shifts.up)
    frac = engine.position_frac[number]
    cells = -(-units >> frac)
    if cells < 0:
        reached["17 ahead by less than nothing"] += 1
    elif cells:
        reached["17 ahead by whole cells" if units == cells << frac else "17 ahead rounded up"] += 1
    return max(0, cells), max(sums) >= part


def pairs_of(grid, border):
    """Section 17, pairs: (component along, first cell, second cell); None is what is beyond the border."""
    pairs = []
    for cell in range(columns(grid) * rows(grid)):
        left, right, above, below = neighbours(grid, cell)
        for along, before, after in ((0, left, right), (1, above, below)):
            if after is not None:
                pairs.append((along, cell, after))
            elif border == "still":
                pairs.append((along, cell, None))
            if before is None and border == "still":
                pairs.append((along, None, cell))
    return pairs


def enlarge(extents, sides):
    """Section 17: the largest, each for itself."""
    for side, extent in sides:
        if extents[side] and extent > 1:
            reached["17 extent of several pairs"] += 1
        extents[side] = max(extents[side], extent)


def mark_disocclusion(engine, reach, front):
    """Section 17, pairs and mark: (extents of each cell, sides to which each is blocked, counts)."""
    grid = engine.grid
    bodies = [body_of(engine, galpixel) for galpixel in front]
    extents = [[0] * 4 for _ in front]
    blocked = [[False] * 4 for _ in front]
    counts = dict.fromkeys(DISOCCLUSION_COUNTS, 0)
    for along, first, second in pairs_of(grid, reach.border):
        across = 1 - along
        one, two = (BEYOND if cell is None else bodies[cell] for cell in (first, second))
        farther = two.key - one.key
        same = abs(farther) < reach.separation
        if abs(farther) == reach.separation:
            reached["17 not of one surface, just so"] += 1
        gap, parts = ahead(engine, reach, along, two, one)
        closer, _ = ahead(engine, reach, along, one, two)
        onwards, _ = ahead(engine, reach, across, two, one)
        backwards, _ = ahead(engine, reach, across, one, two)
        before, after = (LEFT, RIGHT) if along == 0 else (ABOVE, BELOW)
        up, down = (ABOVE, BELOW) if along == 0 else (LEFT, RIGHT)
        if gap > 0 and (not same or reach.tears and parts):
            given = min(gap, SATURATED), min(onwards + 1, SATURATED), min(backwards + 1, SATURATED)
            counts["edges"] += 1
            if SATURATED in given:
                reached[f"17 saturated {('along', 'onwards', 'backwards')[given.index(SATURATED)]}"] += 1
                counts["endless"] += 1
            if None in (first, second):
                reached[f"17 opens at the border, {SIDES[before if first is None else after]}"] += 1
            reached[f"17 opens along {COMPONENTS[along]}, {'tears' if same else 'farther' if farther > 0 else 'nearer' if farther else 'equal'}"] += 1
            if second is not None and (same or farther <= 0):
                enlarge(extents[second], ((after, given[0]), (before, 1), (down, given[1]), (up, given[2])))
            if first is not None and (same or farther >= 0):
                enlarge(extents[first], ((before, given[0]), (after, 1), (down, given[2]), (up, given[1])))
        elif gap > 0:
            reached["17 of one surface, parts" if parts else "17 of one surface, does not part"] += 1
        if reach.through or same or farther == 0:
            if not reach.through and not same:
                reached["17 equal keys block nothing"] += 1
            continue
        if max(gap, closer, onwards, backwards) < 2:
            reached["17 not far enough to be blocked"] += 1
            continue
        far = [name for name, cells in zip(("gap", "closer", "onwards", "backwards"), (gap, closer, onwards, backwards))
               if cells >= 2]
        if len(far) == 1:
            reached[f"17 blocked by {far[0]} alone"] += 1
        cell, side = (second, after) if farther > 0 else (first, before)
        if cell is not None:
            reached[f"17 blocked to {SIDES[side]}"] += 1
            blocked[cell][side] = True
    for cell, galpixel in enumerate(front):
        if galpixel["class"] == EMPTY:
            reached["17 class 3 covers itself"] += 1
            extents[cell] = [max(1, extent) for extent in extents[cell]]
    return extents, blocked, counts


def scan(grid, side):
    """Section 17, spread: (cell before, cell) in the order of a scan to a side."""
    cells = range(columns(grid) * rows(grid))
    for cell in cells if side in (RIGHT, BELOW) else reversed(cells):
        before = neighbours(grid, cell)[OPPOSITE[side]]
        if before is not None:
            yield before, cell


def spread_disocclusion(grid, extents, blocked):
    """Section 17, spread: extents of each cell; all of them are open."""
    spread = [list(of) for of in extents]
    for side in (RIGHT, LEFT, BELOW, ABOVE):
        opposite = OPPOSITE[side]
        for before, cell in scan(grid, side):
            source, own = spread[before], spread[cell]
            if source[side] < 2:
                if source[side]:
                    reached[f"17 spread {SIDES[side]} ends"] += 1
                continue
            if blocked[cell][side]:
                reached[f"17 spread {SIDES[side]}: blocked"] += 1
                continue
            if any(blocked[cell]):
                reached["17 spread: blocked to another side"] += 1
            reached[f"17 spread {SIDES[side]} goes on"] += 1
            if source[side] == SATURATED:
                reached["17 spread: 127 stays"] += 1
            for of in range(4):
                carried = source[of]
                if of == side and carried < SATURATED:
                    carried -= 1
                elif of == opposite:
                    carried = 1
                if own[of] > carried:
                    reached["17 spread: its own is larger"] += 1
                own[of] = max(own[of], carried)
    return spread


def extent_words(extents, blocked):
    """Section 17, words."""
    return [sum((extent | closed << 7) << 8 * side for side, (extent, closed) in enumerate(zip(of, closed_of)))
            for of, closed_of in zip(extents, blocked)]


def disocclusion(engine, reach, front):
    """Section 17: (marked words, spread words, words of the mask, counts)."""
    extents, blocked, counts = mark_disocclusion(engine, reach, front)
    spread = spread_disocclusion(engine.grid, extents, blocked)
    words = extent_words(spread, [[False] * 4] * len(spread))
    covered = [word != 0 for word in words]
    counts["covered"] = sum(covered)
    reached["17 all covered" if all(covered) else "17 none covered" if not any(covered) else "17 some covered"] += 1
    return extent_words(extents, blocked), words, edge_words(covered), counts


# --- 18. Grafting an object ------------------------------------------------------------------------------------------

Rendering = namedtuple("Rendering", "tag stamp place size galpixels")

GRAFTED = ("removed", "put", "behind", "lost", "empty", "replaced", "saturated")


def without_object(galpixels, tag, counts):
    """Section 18, step 1."""
    result = []
    for galpixel in galpixels:
        if galpixel["class"] == EMPTY:
            reached["18 empty stays, whatever its tag"] += 1
        elif galpixel["tag"] != tag:
            reached["18 another tag stays"] += 1
        else:
            reached[f"18 class {galpixel['class']} of the tag is removed"] += 1
            counts["removed"] += 1
            galpixel = dict(empty_galpixel(), colour=galpixel["colour"])
        result.append(galpixel)
    return result


def caught_up(engine, galpixel, cell, stamp, rounding, n):
    """Section 18, step 2: (cell or None, galpixel, fields that saturated)."""
    saturated = 0
    while stamp != n and cell is not None:
        reached["18 a missed step"] += 1
        thresholds = thresholds_of(engine, rounding, stamp)
        galpixel, right, down, fields = step_galpixel(engine, galpixel, thresholds)
        saturated += fields
        cell = target_cell(engine.grid, cell, right, down)
        stamp = (stamp + 1) % (1 << 32)
    return cell, galpixel, saturated


def enter_object(engine, galpixels, rendering, rounding, n):
    """Section 18: (map with the rendering, counts)."""
    counts = dict.fromkeys(GRAFTED, 0)
    result = without_object(galpixels, rendering.tag, counts)
    arrivals = {}
    for index, galpixel in enumerate(rendering.galpixels):
        down, right = divmod(index, rendering.size[0])
        if galpixel["class"] == EMPTY:
            reached["18 nothing in a cell of the rectangle"] += 1
            counts["empty"] += 1
            continue
        if galpixel["tag"] != rendering.tag:
            reached["18 takes the rendering's tag"] += 1
        start = (rendering.place[1] + down) * columns(engine.grid) + rendering.place[0] + right
        cell, galpixel, fields = caught_up(engine, dict(galpixel, tag=rendering.tag), start, rendering.stamp, rounding, n)
        counts["saturated"] += fields
        if cell is None:
            reached["18 lost on the way"] += 1
            counts["lost"] += 1
        else:
            arrivals.setdefault(cell, []).append(galpixel)
    for cell, there in arrivals.items():
        before = result[cell]
        known = before["class"] != EMPTY
        # sorting is stable: the one that was there comes first, then the rectangle's order
        everybody = sorted(([before] if known else []) + there, key=lambda g: (g["class"], g["depth"]))
        counts["behind"] += len(there)
        if known and everybody[0] is before:
            same = [(g["class"], g["depth"]) == (before["class"], before["depth"]) for g in there]
            reached["18 of equals the one that was there" if any(same) else "18 behind what was there"] += 1
            continue
        if len(there) > 1:
            first, second = everybody[:2]
            equal = (first["class"], first["depth"]) == (second["class"], second["depth"])
            reached["18 of several equals the first" if equal else "18 of several the nearest"] += 1
        reached["18 replaces what was there" if known else "18 into an empty cell"] += 1
        counts["behind"] -= 1
        counts["put"] += 1
        counts["replaced"] += known
        result[cell] = everybody[0]
    return result, counts


# --- 20. Sub-cell scan-out -------------------------------------------------------------------------------------------

ALIKE = 96                                          # counts 256ths of a cell
TOWARDS = ((-1, 0), (1, 0), (0, -1), (0, 1))        # leads to the neighbours, in the order of SIDES


def part(engine, galpixel, number):
    """Section 20, parts: that of x (number 0) or of y (1)."""
    name = f"offset_{COMPONENTS[number]}"
    if not engine.widths[name]:
        reached["20 part without an offset field"] += 1
        return 0
    o, f = galpixel[name], engine.position_frac[number]
    if f <= 8:
        reached["20 part, f < 8" if f < 8 else "20 part, f = 8"] += 1
        return o << (8 - f)
    rounded = (o + (1 << (f - 9))) >> (f - 8)
    if low_bits(o, f - 8) == 1 << (f - 9):
        reached["20 part, f > 8, half"] += 1
    else:
        reached["20 part, f > 8, rounds up" if rounded > o >> (f - 8) else "20 part, f > 8, rounds down"] += 1
    if rounded == 128:
        reached["20 part, f > 8, half a cell"] += 1
    return rounded


def galpixel_at(engine, galpixels, column, row):
    """Section 20: the galpixel of a cell of the map; outside of the map one of class 3."""
    if not (0 <= column < columns(engine.grid) and 0 <= row < rows(engine.grid)):
        reached["20 outside of the map"] += 1
        return empty_galpixel()
    return galpixels[row * columns(engine.grid) + column]


def join(one, other, limit):
    """Section 20: whether two cells join."""
    for galpixel in (one, other):
        if galpixel["class"] == EMPTY:
            reached["20 do not join: class 3"] += 1
            return False
    difference = abs(one["depth"] - other["depth"])
    if difference > limit:
        reached["20 do not join: depth"] += 1
        return False
    if one["class"] != other["class"]:
        reached["20 join, classes differ"] += 1
    if difference:
        reached["20 join, just so" if difference == limit else "20 join, depths differ"] += 1
    return True


def parts_alike(engine, one, other, number):
    """Section 20: whether the parts of two cells that join allow to mix them."""
    difference = abs(part(engine, one, number) - part(engine, other, number))
    name = COMPONENTS[number]
    if difference > ALIKE:
        reached[f"20 parts in {name} not alike{', just so' if difference == ALIKE + 1 else ''}"] += 1
        return False
    if difference == ALIKE:
        reached[f"20 parts in {name} alike, just so"] += 1
    return True


def round_256ths(total, what):
    """Sections 20 and 21: the nearest whole number to a number of 256ths, halves upwards."""
    rest = low_bits(total, 8)
    if rest:
        kind = {127: "just below half", 128: "half"}.get(rest, "rounds up" if rest > 128 else "rounds down")
        reached[f"{what}, {kind}"] += 1
    return (total + 128) >> 8


def bilinear(engine, galpixels, column, row, limit):
    """Section 20, bilinear: the channels of the cell at `column`, `row` of the map."""
    own = galpixel_at(engine, galpixels, column, row)
    ox, oy = part(engine, own, 0), part(engine, own, 1)
    sx, sy = -1 if ox > 0 else 1, -1 if oy > 0 else 1
    beside = galpixel_at(engine, galpixels, column + sx, row)
    below = galpixel_at(engine, galpixels, column, row + sy)        # stands for the one above too
    corner = galpixel_at(engine, galpixels, column + sx, row + sy)
    p = abs(ox) if join(own, beside, limit) and parts_alike(engine, beside, own, 0) else 0
    q = abs(oy) if join(own, below, limit) and parts_alike(engine, below, own, 1) else 0
    d = 0
    if join(own, corner, limit):
        d = round_256ths(p * q, "20 bilinear corner")
    if p and q:
        reached["20 bilinear, both axes" if join(own, corner, limit) else "20 bilinear, corner not joined"] += 1
    elif p or q:
        reached["20 bilinear, x alone" if p else "20 bilinear, y alone"] += 1
    else:
        reached["20 bilinear, nothing"] += 1
    if p:
        reached["20 bilinear from the left" if sx < 0 else "20 bilinear from the right"] += 1
    if q:
        reached["20 bilinear from above" if sy < 0 else "20 bilinear from below"] += 1
    channels = []
    for c, a, b, e in zip(*(split_channels(galpixel["colour"], engine.layout.colour)
                            for galpixel in (own, beside, below, corner))):
        channels.append(round_256ths(c * (256 - p - q + d) + a * (p - d) + b * (q - d) + e * d, "20 bilinear"))
    return channels


def covers(one, other, limit):
    """Section 20: whether a cell covers another one."""
    if EMPTY in (one["class"], other["class"]):
        return False
    farther = other["depth"] - one["depth"]
    if farther > limit:
        reached[f"20 class {one['class']} covers class {other['class']}"] += 1
        return True
    if farther and farther == limit:
        reached["20 just does not cover"] += 1
    return False


def silhouettes(engine, galpixels, column, row, limit, channels):
    """Section 20, silhouettes: the channels after all four neighbours, in the order of SIDES."""
    own = galpixel_at(engine, galpixels, column, row)
    mixed = 0
    for side, (right, down) in enumerate(TOWARDS):
        neighbour = galpixel_at(engine, galpixels, column + right, row + down)
        number = 0 if right else 1
        if covers(neighbour, own, limit):
            o, how = part(engine, neighbour, number), "covers the cell"
        elif covers(own, neighbour, limit):
            o, how = part(engine, own, number), "is covered"
        else:
            continue
        t = o if side in (LEFT, ABOVE) else -o
        if t <= 0:
            reached[f"20 silhouette, {SIDES[side]} {how}, but not shown"] += 1
            continue
        reached[f"20 silhouette, {SIDES[side]} {how}"] += 1
        mixed += 1
        colours = split_channels(neighbour["colour"], engine.layout.colour)
        channels = [round_256ths(v * (256 - t) + n * t, "20 silhouette") for v, n in zip(channels, colours)]
    if mixed:
        reached["20 silhouette alone" if mixed == 1 else "20 several silhouettes"] += 1
    return channels


def scan_out(engine, galpixels, limit):
    """Section 20: the colour of each cell of the display, row by row; `limit` is the threshold."""
    reached[f"20 colour {engine.layout.colour}"] += 1
    reached["20 depths" if engine.layout.depth_bits else "20 no depth field"] += 1
    reached["20 threshold 0" if limit == 0 else "20 threshold above 0"] += 1
    grid = engine.grid
    shown = []
    for row in range(grid.top, grid.top + grid.height):
        for column in range(grid.left, grid.left + grid.width):
            own = galpixel_at(engine, galpixels, column, row)
            reached[f"20 shown, class {own['class']}"] += 1
            resampled = bilinear(engine, galpixels, column, row, limit)
            channels = silhouettes(engine, galpixels, column, row, limit, resampled)
            before = split_channels(own["colour"], engine.layout.colour)
            if before != resampled != channels:
                reached["20 silhouette over bilinear"] += 1
            if any(not in_display(grid, column + right, row + down) and channels != before
                   for right, down in TOWARDS if 0 <= column + right < columns(grid) and 0 <= row + down < rows(grid)):
                reached["20 beside the margin"] += 1
            shown.append(join_channels(channels, engine.layout.colour))
    return shown


# --- 21. Stationary sources ------------------------------------------------------------------------------------------

DEPTH_15 = 15
NO_ENTRY_DEPTH = (1 << DEPTH_15) - 1
FARTHEST = NO_ENTRY_DEPTH - 1                       # the depth of an entry is at most this
QUAD, POINT = 0, 1
NO_KEY, NO_ENTRY = (1 << 16) - 1, (1 << 32) - 1     # what vectors show of a cell without an entry
STRETCHED = 44                                      # counts 32ths of a cell
TRIED = 4                                           # columns or rows that a quad may try
# what is said of a pair: bit 0 that the first ends in front, bit 1 that the second does, both that it is linked
NEITHER, FIRST_ENDS, SECOND_ENDS, LINKED = range(4)
WAYS = ((1, 0), (0, 1), (1, 1), (1, -1))            # t of the cracks, in the order in which they are tried

SourceLayer = namedtuple("SourceLayer", "grid galpixels displacements links mixed")
Sources = namedtuple("Sources", "engine limit e layers")    # limit in units of the depth field, e is E
Entry = namedtuple("Entry", "depth kind number u v")
Links = namedtuple("Links", "right below")                  # of each cell, what is said of its two pairs


def to_15_bits(engine, value):
    """Section 21: a depth, or the threshold, for depths of 15 bits."""
    d = engine.widths["depth"]
    return value >> (d - DEPTH_15) if d > DEPTH_15 else value << (DEPTH_15 - d)


def depth_of(sources, sample):
    """Section 21: the depth of a sample."""
    return to_15_bits(sources.engine, sample["depth"])


def layer_of(sources, number):
    """Section 21, samples: (layer, cell) of the sample with a number."""
    for layer, of in enumerate(sources.layers):
        if number < len(of.galpixels):
            return layer, number
        number -= len(of.galpixels)
    raise AssertionError("no sample has this number")


def number_of(sources, layer, cell):
    """Section 21, samples: the number of the sample at a cell of a layer."""
    return sum(len(of.galpixels) for of in sources.layers[:layer]) + cell


def is_sample(galpixel):
    """Section 21, samples: whether a cell's galpixel is one."""
    if galpixel["class"] != GALPIXEL:
        reached[f"21 class {galpixel['class']} is no sample"] += 1
        return False
    return True


def does_step(four, limit, field):
    """Section 21, links: whether a value steps between the second and the third of four; None where is no sample."""
    p, a, b, n = four
    differences = {"of the pair": b - a}
    if p is not None:
        differences["before"] = (b - a) - (a - p)
    if n is not None:
        differences["after"] = (n - b) - (b - a)
    small = [name for name, difference in differences.items() if abs(difference) <= limit]
    if small:
        if len(small) == 1:
            just = abs(differences[small[0]]) == limit
            reached[f"21 no step only by the difference {small[0]}{', just so' if just else ''}"] += 1
        return False
    for name in ("before", "after"):
        if name not in differences:
            reached[f"21 step without a sample {name}"] += 1
    return True


def link(sources, grid, galpixels, cell, direction):
    """Section 21, links: what is said of a cell and the one to the right or below; None where that is no pair."""
    engine, side = sources.engine, SIDES[direction]

    def sample_at(steps):
        column, row = cell % columns(grid), cell // columns(grid)
        column, row = column + steps * TOWARDS[direction][0], row + steps * TOWARDS[direction][1]
        if not (0 <= column < columns(grid) and 0 <= row < rows(grid)):
            return None
        galpixel = galpixels[row * columns(grid) + column]
        return galpixel if is_sample(galpixel) else None

    four = [sample_at(steps) for steps in (-1, 0, 1, 2)]
    one, other = four[1:3]
    if one is None or other is None:
        return None
    limits = {"depth": sources.limit,
              **{f"velocity_{name}": (1 << engine.budget.components[number].velocity_frac) >> 2
                 for number, name in enumerate("xy")}}
    steps = [field for field, limit in limits.items()
             if does_step([galpixel and galpixel[field] for galpixel in four], limit, field)]
    if not steps:
        reached[f"21 linked with {side}"] += 1
        return LINKED
    reached[f"21 only the {steps[0]} steps, {side}" if len(steps) == 1 else "21 several fields step"] += 1
    if one["depth"] == other["depth"]:
        reached["21 not linked, neither ends"] += 1
        return NEITHER
    first = one["depth"] < other["depth"]
    reached[f"21 not linked with {side}, the {'first' if first else 'second'} ends"] += 1
    return FIRST_ENDS if first else SECOND_ENDS


def make_links(sources, grid, galpixels):
    """Section 21, links: of all cells of a layer, when it is updated."""
    return [Links(*(link(sources, grid, galpixels, cell, direction) or NEITHER for direction in (RIGHT, BELOW)))
            for cell in range(len(galpixels))]


def link_number(links):
    """The number by which vectors show the links of a cell."""
    return links.right | links.below << 2


def make_sources(engine, limit, maps):
    """Section 21: the layers as an update leaves them, of a list of (grid, galpixels, displacements)."""
    if (columns(maps[0][0]), rows(maps[0][0])) != (columns(engine.grid), rows(engine.grid)):
        raise Refused("layer 0 has not the columns and rows of the map")
    if any(columns(grid) > columns(engine.grid) for grid, _, _ in maps):
        raise Refused("a layer is wider than the map")
    if any(columns(grid) < columns(engine.grid) for grid, _, _ in maps):
        reached["21 a layer with fewer columns"] += 1
    if sum(len(galpixels) for _, galpixels, _ in maps) > 1 << 22:
        raise Refused("there are more than 2^22 numbers of samples")
    d = engine.widths["depth"]
    reached["21 no depth field" if d == 0 else "21 depth below 15 bits" if d < DEPTH_15 else
            "21 depth of 15 bits" if d == DEPTH_15 else "21 depth above 15 bits"] += 1
    reached["21 one layer" if len(maps) == 1 else "21 several layers"] += 1
    if limit > (1 << 31) - 1:
        reached["21 threshold above 2^31 - 1"] += 1
        limit = (1 << 31) - 1
    e = to_15_bits(engine, limit)
    if e > 1 << DEPTH_15:
        reached["21 E is 2^15"] += 1
        e = 1 << DEPTH_15
    sources = Sources(engine, limit, e, [])
    for number, (grid, galpixels, displacements) in enumerate(maps):
        sources.layers.append(SourceLayer(grid, galpixels, displacements, make_links(sources, grid, galpixels), None))
        sources.layers[number] = sources.layers[number]._replace(mixed=has_mixed_rims(sources, number))
    return sources


def pair(sources, layer, cell, side):
    """Section 21, links: (cell at that side or None, what is said of the two; here the first is `cell` itself)."""
    other = neighbours(sources.layers[layer].grid, cell)[side]
    if other is None:
        return None, NEITHER
    if side in (RIGHT, BELOW):
        of = sources.layers[layer].links[cell]
        return other, of.right if side == RIGHT else of.below
    of = sources.layers[layer].links[other]
    said = of.right if side == LEFT else of.below
    return other, {FIRST_ENDS: SECOND_ENDS, SECOND_ENDS: FIRST_ENDS}.get(said, said)


def linked_with(sources, layer, cell, side):
    """Section 21, links: the cell at that side if it is linked with `cell`, else None."""
    other, said = pair(sources, layer, cell, side)
    return other if said == LINKED else None


def quad_of(sources, layer, cell):
    """Section 21, links: the cells (A, B, D) of the quad of a cell, or None."""
    right, below = linked_with(sources, layer, cell, RIGHT), linked_with(sources, layer, cell, BELOW)
    if right is None or below is None:
        return None
    fourth = right + columns(sources.layers[layer].grid)
    if linked_with(sources, layer, right, BELOW) is None or linked_with(sources, layer, below, RIGHT) is None:
        reached["21 no quad only for the fourth sample"] += 1
        return None
    return right, below, fourth


def step_sources(sources, rounding, n):
    """Section 21, step: (sources after it, fields that saturated)."""
    thresholds = thresholds_of(sources.engine, rounding, n)
    low, high = lowest(16), highest(16)
    layers, saturated = [], 0
    for grid, galpixels, displacements, links, mixed in sources.layers:
        galpixels, displacements = list(galpixels), list(displacements)
        for cell, galpixel in enumerate(galpixels):
            if not is_sample(galpixel):
                continue
            galpixels[cell], right, down, fields = step_galpixel(sources.engine, galpixel, thresholds)
            saturated += fields
            wanted = displacements[cell][0] + right, displacements[cell][1] + down
            place = tuple(clamp(number, low, high) for number in wanted)
            for name, number, got in zip("xy", wanted, place):
                if number != got:
                    reached[f"21 displacement in {name} clamped at the {'lowest' if number < got else 'highest'}"] += 1
                    saturated += 1
            displacements[cell] = place
        layers.append(SourceLayer(grid, galpixels, displacements, links, mixed))
    return sources._replace(layers=layers), saturated


def part_of_bits(engine, galpixel, number, b):
    """Section 21, step: the part of x (number 0) or y (1) with `b` bits."""
    name = f"offset_{COMPONENTS[number]}"
    if not engine.widths[name]:
        reached["21 part without an offset field"] += 1
        return 0
    o, f = galpixel[name], engine.position_frac[number]
    if f <= b:
        reached[f"21 part with {b} bits, {'f < b' if f < b else 'f = b'}"] += 1
        return o << (b - f)
    half = low_bits(o, f - b) == 1 << (f - b - 1)
    reached[f"21 part with {b} bits, f > b{', half' if half else ''}"] += 1
    return (o + (1 << (f - b - 1))) >> (f - b)


def entry_depth(depth, kind):
    """Section 21, entries: at most 2^15 - 2."""
    if depth > FARTHEST:
        reached[f"21 depth of a {'quad' if kind == QUAD else 'point'} is at most 2^15 - 2"] += 1
        return FARTHEST
    return depth


def point_of(sources, layer, cell):
    """Section 21, points: (cell on the grid or None, its entry)."""
    engine = sources.engine
    own, galpixels, displacements, _, _ = sources.layers[layer]
    row, column = divmod(cell, columns(own))
    column, row = column + displacements[cell][0], row + displacements[cell][1]
    outside = [side for side, off in zip(SIDES, (column < 0, column >= columns(engine.grid), row < 0,
                                                 row >= rows(engine.grid))) if off]
    if outside:
        for side in outside:
            reached[f"21 point off the grid, {side}"] += 1
        return None, None
    sample = galpixels[cell]
    residual = (-part_of_bits(engine, sample, number, 4) for number in range(2))
    depth = entry_depth(depth_of(sources, sample) + (sources.e >> 1), POINT)
    entry = Entry(depth, POINT, number_of(sources, layer, cell), *residual)
    return row * columns(engine.grid) + column, entry


def place_of(sources, layer, cell):
    """Section 21, stretched quads: P, in 32ths of a cell."""
    _, galpixels, displacements, _, _ = sources.layers[layer]
    return tuple(displacements[cell][number] * 32 + part_of_bits(sources.engine, galpixels[cell], number, 5)
                 for number in range(2))


def reciprocal(area):
    """Section 21, stretched quads: r. `k` is the length of `area` in bits: its highest set bit is bit k - 1."""
    k = area.bit_length()
    if k >= 7:
        reached["21 reciprocal, k above 7" if k > 7 else "21 reciprocal, k is 7"] += 1
        return (1 << 20) // (area >> (k - 7)) >> (k - 7)
    if area == 32:
        reached["21 reciprocal, least area"] += 1
    reached["21 reciprocal, k below 7"] += 1
    return (1 << 20) // (area << (7 - k)) << (7 - k)


def within(number, area):
    """Section 21, stretched quads: whether u or v of a cell is within the quad and a quarter more."""
    low, high = -(area >> 2), area + (area >> 2)
    if number in (low, high):
        reached[f"21 just within a quad, {'low' if number == low else 'high'}"] += 1
    elif number in (low - 1, high + 1):
        reached[f"21 just not within a quad, {'low' if number < low else 'high'}"] += 1
    return low <= number <= high


def quad_entries(sources, layer, cell, others):
    """Section 21, stretched quads: list of (cell of the grid, entry) that a quad gives."""
    grid = sources.engine.grid
    row, column = divmod(cell, columns(sources.layers[layer].grid))
    own = place_of(sources, layer, cell)
    sides = ((32, 0), (0, 32), (32, 32))
    a, b, d = (tuple(other - mine + side for other, mine, side in zip(place_of(sources, layer, of), own, by))
               for of, by in zip(others, sides))
    long = [name for name, number in zip(("a_x", "a_y", "b_x", "b_y"), a + b) if abs(number) > STRETCHED]
    if not long:
        reached["21 quad not stretched"] += 1
        if any(abs(number) == STRETCHED for number in a + b):
            reached["21 quad not stretched, just so"] += 1
        return []
    if len(long) == 1:
        negative = dict(zip(("a_x", "a_y", "b_x", "b_y"), a + b))[long[0]] < 0
        reached[f"21 quad stretched only by {long[0]}{', negative' if negative else ''}"] += 1
    s = (32 * column + own[0], 32 * row + own[1])
    ranges = []
    for number in range(2):
        corners_at = [0, a[number], b[number], d[number]]
        # the first is rounded up, the last down
        ranges.append(range(-(-(s[number] + min(corners_at)) // 32), (s[number] + max(corners_at) - 1) // 32 + 1))
    area = a[0] * b[1] - a[1] * b[0]
    none = [name for name, off in (("columns", len(ranges[0]) > TRIED), ("rows", len(ranges[1]) > TRIED),
                                   ("area", area < 32)) if off]
    if none:
        if len(none) == 1:
            reached[f"21 quad tries none only for its {none[0]}"] += 1
        return []
    if TRIED in (len(ranges[0]), len(ranges[1])):
        reached["21 quad tries 4 columns or rows"] += 1
    r = reciprocal(area)
    entries = []
    for j in ranges[1]:
        for i in ranges[0]:
            if not (0 <= i < columns(grid) and 0 <= j < rows(grid)):
                reached["21 cell of a quad is off the grid"] += 1
                continue
            e = (32 * i - s[0], 32 * j - s[1])
            uv = (b[1] * e[0] - b[0] * e[1], a[0] * e[1] - a[1] * e[0])
            inside = [within(number, area) for number in uv]
            if not all(inside):
                reached["21 cell not in a quad" if not any(inside) else
                        f"21 cell not in a quad only by {'v' if inside[0] else 'u'}"] += 1
                continue
            residual = []
            for number in uv:
                number = (number * r + (1 << 15)) >> 16
                if not 0 <= number <= 15:
                    reached["21 residual in a quad at least 0" if number < 0 else
                            "21 residual in a quad at most 15"] += 1
                residual.append(clamp(number, 0, 15))
            sample = sources.layers[layer].galpixels[cell]
            number = number_of(sources, layer, cell)
            entries.append((j * columns(grid) + i,
                            Entry(entry_depth(depth_of(sources, sample), QUAD), QUAD, number, *residual)))
    reached["21 quad gives entries" if entries else "21 quad gives no entry"] += 1
    return entries


def all_entries(sources):
    """Section 21, entries: the one that each cell shows, or None; and the numbers of samples and of lost ones."""
    grid = sources.engine.grid
    cells = columns(grid) * rows(grid)
    best = [None] * cells
    moved = lost = 0

    def enter(cell, entry):
        other = best[cell]
        if other is not None:
            level = next(name for name in ("depth", "kind", "number")
                         if getattr(entry, name) != getattr(other, name))
            several = level == "number" and \
                layer_of(sources, entry.number)[0] != layer_of(sources, other.number)[0]
            reached[f"21 entries by {level}{', of several layers' if several else ''}"] += 1
        if other is None or entry[:3] < other[:3]:
            best[cell] = entry

    for layer, (_, galpixels, _, _, _) in enumerate(sources.layers):
        for cell, galpixel in enumerate(galpixels):
            if not is_sample(galpixel):
                continue
            moved += 1
            at, entry = point_of(sources, layer, cell)
            if at is None:
                lost += 1
            else:
                enter(at, entry)
            others = quad_of(sources, layer, cell)
            if others is not None:
                for at, entry in quad_entries(sources, layer, cell, others):
                    enter(at, entry)
    return best, moved, lost


def shown_depth(entry):
    """Section 21, entries: the depth of a cell."""
    return NO_ENTRY_DEPTH if entry is None else entry.depth


def samples_joined(sources, one, other):
    """Section 21, cracks: whether the samples of two numbers are joined."""
    (layer, cell), (other_layer, target) = layer_of(sources, one), layer_of(sources, other)
    grid = sources.layers[layer].grid
    if layer != other_layer:
        reached["21 not joined: layers"] += 1
        return False
    right = target % columns(grid) - cell % columns(grid)
    down = target // columns(grid) - cell // columns(grid)
    if abs(right) > 2 or abs(down) > 2:
        reached["21 not joined: columns" if abs(down) <= 2 else "21 not joined: rows" if abs(right) <= 2 else
                "21 not joined: columns and rows"] += 1
        return False
    # In turns along the row and along the column, so that a path does not lead around a hole between the two.
    way, across, along = [], abs(right), abs(down)
    while across or along:
        if across:
            way.append(LEFT if right < 0 else RIGHT)
            across -= 1
        if along:
            way.append(ABOVE if down < 0 else BELOW)
            along -= 1
    for side in way:
        cell = linked_with(sources, layer, cell, side)
        if cell is None:
            reached["21 not joined: links"] += 1
            return False
    reached["21 joined: the same" if not way else "21 joined: one side" if len(way) == 1 else
            "21 joined: round a corner" if right and down else "21 joined: two on a line"] += 1
    return True


def closed_by(sources, entries, cell, t):
    """Section 21, cracks: (distance, entry before it is clamped) by the neighbours at -t and t, or None."""
    grid = sources.engine.grid
    row, column = divmod(cell, columns(grid))
    ends = [(column - t[0], row - t[1]), (column + t[0], row + t[1])]
    if not all(0 <= x < columns(grid) and 0 <= y < rows(grid) for x, y in ends):
        reached["21 crack: off the grid"] += 1
        return None
    f, g = (entries[y * columns(grid) + x] for x, y in ends)
    if f is None or g is None:
        reached["21 crack: a neighbour without an entry"] += 1
        return None
    own = entries[cell]
    if own is not None:
        behind = own.depth - sources.e
        if not (f.depth < behind and g.depth < behind):
            if max(f.depth, g.depth) == behind:
                reached["21 crack: just not behind"] += 1
            elif min(f.depth, g.depth) < behind:
                reached["21 crack: behind one alone"] += 1
            return None
    if not samples_joined(sources, f.number, g.number):
        return None
    candidates = []
    for entry, by in ((f, 16), (g, -16)):
        u, v = entry.u + by * t[0], entry.v + by * t[1]
        candidates.append((abs(u) + abs(v), entry._replace(u=u, v=v)))
    (near, _), (far, _) = candidates
    name = "(%d, %d)" % t
    reached[f"21 crack {name}: {'equal, F' if near == far else 'F' if near < far else 'G'}"] += 1
    return candidates[0] if near <= far else candidates[1]


def close_cracks(sources, entries):
    """Section 21, cracks: the entries after they are closed."""
    result = list(entries)
    for cell in range(len(entries)):
        horizontal, vertical = (closed_by(sources, entries, cell, t) for t in WAYS[:2])
        if horizontal and vertical:
            equal = horizontal[0] == vertical[0]
            taken = horizontal if horizontal[0] <= vertical[0] else vertical
            reached["21 crack both ways, equal" if equal else "21 crack both ways, (1, 0)"
                    if taken is horizontal else "21 crack both ways, (0, 1)"] += 1
        else:
            taken = horizontal or vertical or closed_by(sources, entries, cell, WAYS[2]) \
                or closed_by(sources, entries, cell, WAYS[3])
        if not taken:
            continue
        reached["21 crack in an empty cell" if entries[cell] is None else "21 crack over an entry"] += 1
        entry = taken[1]
        u, v = clamp(entry.u, -16, 15), clamp(entry.v, -16, 15)
        if (u, v) != (entry.u, entry.v):
            reached["21 crack: residual clamped"] += 1
        result[cell] = entry._replace(u=u, v=v)
    return result


def could_replace(mine, inner, nearer):
    """Section 21, colour of an entry: whether the channels `inner` could take the place of `mine`, beside `nearer`."""
    return all(abs(n - i) <= 8 * abs(m - i) and abs(m - i) <= abs(n - i) and (m - i) * (n - i) >= 0
               for m, i, n in zip(mine, inner, nearer))


def has_mixed_rims(sources, layer):
    """Section 21, colour of an entry: whether the rims of a layer are mixed."""
    galpixels = sources.layers[layer].galpixels
    t = m = c = 0
    for s in range(len(galpixels)):
        for side in range(len(SIDES)):
            n, said = pair(sources, layer, s, side)
            if said != SECOND_ENDS:
                continue
            i = linked_with(sources, layer, s, OPPOSITE[side])
            j = None if i is None else linked_with(sources, layer, i, OPPOSITE[side])
            if j is None:
                reached["21 rim without two neighbours opposite"] += 1
                continue
            ns, ss, is_, js = (split_channels(galpixels[place]["colour"], sources.engine.layout.colour)
                               for place in (n, s, i, j))
            t += 1
            m += ss != is_ and could_replace(ss, is_, ns)
            c += is_ != js and could_replace(is_, js, ns)
    mixed = m > 2 * c and 4 * m >= t
    if t:
        reached["21 rims mixed" if mixed else "21 rims not mixed: too few" if m > 2 * c else
                "21 rims not mixed: as many inside" if 4 * m >= t else "21 rims not mixed: both"] += 1
    return mixed


def own_colour(sources, entries, cell):
    """Section 21, colour of an entry: the channels s, of the stored colour or in place of it."""
    grid, entry = sources.engine.grid, entries[cell]
    layer, at = layer_of(sources, entry.number)
    galpixels = sources.layers[layer].galpixels

    def channels_at(place):
        return split_channels(galpixels[place]["colour"], sources.engine.layout.colour)

    s = channels_at(at)
    best, result = 0, s
    if not sources.layers[layer].mixed:
        return s
    for side in range(len(SIDES)):
        neighbour, said = pair(sources, layer, at, side)
        if said != SECOND_ENDS:
            continue
        nearer, depth = depth_of(sources, galpixels[neighbour]) + sources.e, depth_of(sources, galpixels[at])
        if not nearer < depth:
            reached["21 mixed: just not nearer now" if nearer == depth else "21 mixed: not nearer now"] += 1
            continue
        beside = neighbours(grid, cell)[side]
        if beside is None:
            reached["21 mixed: beside the border"] += 1
        elif entries[beside] is None:
            reached["21 mixed: none beside it"] += 1
        else:
            above, sample = layer_of(sources, entries[beside].number)
            if depth_of(sources, sources.layers[above].galpixels[sample]) + sources.e < depth:
                reached["21 mixed: nearer beside it"] += 1
                continue
            reached["21 mixed: not nearer beside it"] += 1
        inner = linked_with(sources, layer, at, OPPOSITE[side])
        if inner is None:
            reached["21 mixed: nothing opposite"] += 1
            continue
        total, fits = 0, True
        for mine, n, i in zip(s, channels_at(neighbour), channels_at(inner)):
            m, whole = abs(mine - i), abs(n - i)
            why = None
            if 8 * m < whole:
                why = "too little"
            elif m > whole:
                why = "too much"
            elif (mine - i) * (n - i) < 0:
                why = "the other side"
            elif m and 8 * m == whole:
                reached["21 mixed: an eighth, just so"] += 1
            elif m and m == whole:
                reached["21 mixed: all, just so"] += 1
            if why:
                reached[f"21 mixed: {why}"] += 1
                fits = False
            total += m
        if not fits:
            continue
        if total == 0:
            reached["21 mixed: sum 0"] += 1
        elif total > best:
            reached["21 mixed: a later side with more" if best else f"21 mixed with {SIDES[side]}"] += 1
            best, result = total, channels_at(inner)
        else:
            reached["21 mixed: equal, the first side" if total == best else "21 mixed: a later side with less"] += 1
    return result


def colour_of_entry(sources, entries, cell, sub_cell):
    """Section 21, colour of an entry: the channels."""
    engine, entry = sources.engine, entries[cell]
    layer, at = layer_of(sources, entry.number)
    galpixels = sources.layers[layer].galpixels

    def channels_at(place):
        return split_channels(galpixels[place]["colour"], engine.layout.colour)

    if not sub_cell:
        return channels_at(at)
    s = own_colour(sources, entries, cell)
    side_x, side_y = LEFT if entry.u < 0 else RIGHT, ABOVE if entry.v < 0 else BELOW
    a, b = linked_with(sources, layer, at, side_x), linked_with(sources, layer, at, side_y)
    p, q = (abs(number) if other is not None else 0 for number, other in ((entry.u, a), (entry.v, b)))
    for number, other in ((entry.u, a), (entry.v, b)):
        if number and other is None:
            reached["21 colour: not linked"] += 1
    d = at                                              # stands for any: its weight is 0 unless it is set below
    if p and q:
        # the fourth is beside both: in the row of B, in the column of A
        by_a, by_b = linked_with(sources, layer, a, side_y), linked_with(sources, layer, b, side_x)
        if by_a is None and by_b is None:
            reached[f"21 colour: no fourth, {'equal' if p == q else 'x alone' if p > q else 'y alone'}"] += 1
            if p < q:
                p = 0
            else:
                q = 0
        else:
            reached["21 colour: fourth by both" if by_a is not None and by_b is not None else
                    "21 colour: fourth by A alone" if by_b is None else "21 colour: fourth by B alone"] += 1
            d = by_b if by_a is None else by_a
    if p:
        reached[f"21 colour from {SIDES[side_x]}"] += 1
    if q:
        reached[f"21 colour from {SIDES[side_y]}"] += 1
    if 16 in (p, q):
        reached["21 colour: all of a neighbour"] += 1
    if s != channels_at(at):
        reached["21 mixed, resampled" if p or q else "21 mixed, not resampled"] += 1
    result = []
    for mine, right, below, fourth in zip(s, *(channels_at(at if place is None else place) for place in (a, b, d))):
        total = mine * (16 - p) * (16 - q) + right * p * (16 - q) + below * (16 - p) * q + fourth * p * q
        result.append(round_256ths(total, "21 colour"))
    return result


def fill_sources(sources, entries, colours, fill_mode):
    """Section 21, fill: the channels of all cells; `colours` are those of cells with an entry, None of others."""
    engine = sources.engine
    grid, width = engine.grid, columns(engine.grid)
    base = sources.layers[0].galpixels
    result = list(colours)
    for cell, entry in enumerate(entries):
        if entry is not None:
            continue
        stored = split_channels(base[cell]["colour"], engine.layout.colour)
        klass = base[cell]["class"]
        if fill_mode == "none":
            reached["21 fill none"] += 1
            result[cell] = [0] * len(stored)
        elif klass == EMPTY or fill_mode != "extend":
            reached[f"21 fill {fill_mode}, class {klass}: stored"] += 1
            result[cell] = stored
        else:
            row = cell // width
            # the ends of the run of cells without an entry, of whatever class
            left = next((at for at in range(cell - 1, row * width - 1, -1) if entries[at] is not None), None)
            right = next((at for at in range(cell + 1, (row + 1) * width) if entries[at] is not None), None)
            run = range(row * width if left is None else left + 1, (row + 1) * width if right is None else right)
            if any(base[at]["class"] == EMPTY for at in run):
                reached["21 fill extend, class 3 in the run"] += 1
            if left is None and right is None:
                reached["21 fill extend: no entry in the row"] += 1
                result[cell] = stored
            elif left is None or right is None:
                reached["21 fill extend: only right" if left is None else "21 fill extend: only left"] += 1
                result[cell] = colours[right if left is None else left]
            else:
                depths = entries[left].depth, entries[right].depth
                reached["21 fill extend: equal depths, left" if depths[0] == depths[1] else
                        f"21 fill extend: {'left' if depths[0] > depths[1] else 'right'} is farther"] += 1
                result[cell] = colours[left if depths[0] >= depths[1] else right]
    return result


SourceInpainting = namedtuple("SourceInpainting", "gamma threshold mask texture")   # a mask of None: none


def picture_of(sources, entries, mask, channels):
    """Section 21, fill: the picture that is inpainted."""
    grid = sources.engine.grid
    width = columns(grid)
    base = sources.layers[0].galpixels
    known, holes, depths, moved = [], [], [], []
    for cell, entry in enumerate(entries):
        row = cell // width
        if entry is not None:
            layer, stored = layer_of(sources, entry.number)
            stored_row, stored_column = divmod(stored, columns(sources.layers[layer].grid))
            depths.append(entry.depth)
            moved.append((cell % width - stored_column, row - stored_row))
        else:
            ends = [next((entries[at].depth for at in way if entries[at] is not None), 0)
                    for way in (range(cell - 1, row * width - 1, -1), range(cell + 1, (row + 1) * width))]
            depths.append(max(ends))
            moved.append((0, 0))
            reached["21 inpainted: a cell of class 3 is known" if base[cell]["class"] == EMPTY else
                    "21 inpainted: a hole"] += 1
        known.append(entry is not None or base[cell]["class"] == EMPTY)
        holes.append(not known[-1] and (mask is None or is_masked(mask, cell)))
    return Picture(width, rows(grid), channels, known, holes, depths, moved)


def inpaint_sources(sources, inpainting, picture):
    """Section 21, fill: the channels of all cells, inpainted."""
    name = sources.engine.layout.colour
    if inpainting.texture is None:
        reached["21 inpainted by push-pull"] += 1
        filled = push_pull_picture(sources.engine, inpainting, picture)
    else:
        reached["21 inpainted by metamers"] += 1
        filled = metamers(sources.engine, inpainting, inpainting.texture, picture)
    return [split_channels(filled[cell], name) if cell in filled else channels
            for cell, channels in enumerate(picture.channels)]


def reach_towards(sources, entry, side):
    """Section 21, silhouettes: the reach of an entry towards a side, in sixteenths of a cell."""
    layer, cell = layer_of(sources, entry.number)
    residual = [entry.u, entry.v]
    for number, (before, after) in enumerate(((LEFT, RIGHT), (ABOVE, BELOW))):
        beyond = after if residual[number] > 8 else before if residual[number] < -8 else None
        if beyond is None:
            continue
        other = linked_with(sources, layer, cell, beyond)
        if other is None:
            reached["21 reach: beyond 8, not linked"] += 1
            continue
        reached[f"21 reach: from the sample {SIDES[beyond]}"] += 1
        cell = other
        residual[number] += -16 if beyond == after else 16
    if pair(sources, layer, cell, side)[1] != FIRST_ENDS:
        reached["21 reach: does not end"] += 1
        return 0
    number = residual[0 if side in (LEFT, RIGHT) else 1]
    if cell != layer_of(sources, entry.number)[1] and number:
        along = number != (entry.u if side in (LEFT, RIGHT) else entry.v)
        reached[f"21 reach of another sample{'' if along else ', moved across'}"] += 1
    return number if side in (RIGHT, BELOW) else -number


def source_silhouettes(sources, entries, gathered):
    """Section 21, silhouettes: the channels of all cells; `gathered` are those before."""
    grid, half = sources.engine.grid, sources.e >> 1
    result = []
    for cell, channels in enumerate(gathered):
        mixed = 0
        own = shown_depth(entries[cell])
        for side, neighbour in enumerate(neighbours(grid, cell)):
            if neighbour is None:
                continue
            other = shown_depth(entries[neighbour])
            if own + half < other:
                t, how = reach_towards(sources, entries[cell], side), "is behind"
            elif other + half < own:
                t, how = -reach_towards(sources, entries[neighbour], OPPOSITE[side]), "is in front"
            else:
                if own != other and half in (own - other, other - own):
                    reached["21 silhouette: just not nearer"] += 1
                continue
            if t <= 0:
                if t < 0:
                    reached[f"21 silhouette, {SIDES[side]} {how}, but not shown"] += 1
                continue
            reached[f"21 silhouette, {SIDES[side]} {how}"] += 1
            if entries[cell] is None or entries[neighbour] is None:
                reached["21 silhouette beside a hole"] += 1
            mixed += 1
            channels = [round_256ths(c * (256 - 16 * t) + 16 * n * t, "21 silhouette")
                        for c, n in zip(channels, gathered[neighbour])]
        if mixed:
            reached["21 silhouette alone" if mixed == 1 else "21 several silhouettes"] += 1
        result.append(channels)
    return result


Shown = namedtuple("Shown", "entries gathered colours counts picture")


def show_sources(sources, fill_mode, sub_cell, inpainting=None):
    """Section 21: what the cells of the map show; `colours` is None without sub-cell scan-out, `picture` what is
    inpainted."""
    first, moved, lost = all_entries(sources)
    entries = close_cracks(sources, first)
    holes = [cell for cell, entry in enumerate(first) if entry is None]
    bullets = sum(entries[cell] is not None for cell in holes)
    points = sum(entry is not None and entry.kind == POINT for entry in first)
    counts = {"moved": moved, "lost": lost, "holes": len(holes), "bullets": bullets, "empty": len(holes) - bullets,
              "collided": moved - lost - points}
    colours = [None if entry is None else colour_of_entry(sources, entries, cell, sub_cell)
               for cell, entry in enumerate(entries)]
    gathered = fill_sources(sources, entries, colours, fill_mode)
    picture = None
    if inpainting is not None:
        picture = picture_of(sources, entries, inpainting.mask, gathered)
        gathered = inpaint_sources(sources, inpainting, picture)
    reached["21 with sub-cell scan-out" if sub_cell else "21 without sub-cell scan-out"] += 1
    words = [join_channels(channels, sources.engine.layout.colour) for channels in gathered]
    if not sub_cell:
        return Shown(entries, words, None, counts, picture)
    after = source_silhouettes(sources, entries, gathered)
    shown = [join_channels(channels, sources.engine.layout.colour) for channels in after]
    return Shown(entries, words, shown, counts, picture)


def entry_key(entry):
    """Section 21, entries: the key of 16 bits."""
    return NO_KEY if entry is None else entry.depth << 1 | entry.kind


def entry_word(entry):
    """Section 21, entries: number, residual in x and in y, from the most significant bit."""
    if entry is None:
        return NO_ENTRY
    return entry.number << 10 | low_bits(entry.u, 5) << 5 | low_bits(entry.v, 5)


# --- The rules -------------------------------------------------------------------------------------------------------

def rule_names():
    """All names that the kinds of vector files can reach."""
    names = []
    for field in ("depth", "velocity", "acceleration", "depth_motion", "luminosity", "tag"):
        names += [f"3 {field} field", f"3 no {field} field"]
    names += ["4 first fit", "4 end to end", "4 field spills"]
    names += ["5 threshold 0: no bits dropped", "5 threshold truncate", "5 threshold nearest",
              "5 threshold low-discrepancy", "5 threshold searched, no table"]
    names += [f"5 threshold searched, down {down}" for down in SEARCHED]
    names += ["5 step without acceleration field", "5 step, acceleration_up > 0", "5 step, acceleration_up 0",
              "5 step, bits dropped", "5 step, up > 0", "5 step, neither down nor up",
              "5 velocity clamped at the lowest", "5 velocity clamped at the highest"]
    names += [f"5 step, threshold rounds up, down {down}" for down in (*SEARCHED, "more")]
    for name in COMPONENTS:
        names += [f"5 velocity_{name} saturates at the lowest", f"5 velocity_{name} saturates at the highest"]
    names += ["5 cells, position_frac 0", "5 cells, half goes upwards", "5 depth moves freely",
              "5 depth clamped at 0", "5 depth clamped at all ones", "5 luminosity steps < 0",
              "5 luminosity steps 0", "5 luminosity steps > 0", "5 luminosity, channel wider than L",
              "5 luminosity, channel clamped at 0", "5 luminosity, channel clamped at all ones",
              "5 just unobscured becomes debris", "5 class stays", "5 without velocity stays in its cell"]
    for side in ("left", "right", "top", "bottom"):
        names += [f"6 wing {side}", f"6 no wing {side}"]
    names += ["7 lost to the left", "7 lost to the right", "7 lost at the top", "7 lost at the bottom",
              "7 out of a wing into the display", "7 out of the display into a wing", "7 moved left",
              "7 moved right", "7 moved up", "7 moved down", "7 stays in its cell", "7 empty sends nothing",
              "7 resolved by class", "7 resolved by depth", "7 resolved by source", "7 hole"]
    names += [f"8 nothing {side}: the cell itself" for side in ("left", "right", "above", "below")]
    names += [f"8 edge only by {reason}" for reason in
              ("own class", "class left", "class right", "class above", "class below", "nearer than around it",
               "farther than around it")]
    names += ["8 edge by several reasons", "8 no edge", "8 difference equal to the threshold",
              "8 threshold above 2^31 - 1", "8 last word not full"]
    names += [f"9 format {name}" for name in FORMATS]
    names += ["10 K = 1 for the fill mode", "10 reach below 1", "10 reach above 16", "10 reach as it is",
              "10 not inside: outside of the map", "10 not inside: hole", "10 not inside: edge",
              "10 not inside: edge, class 2", "10 inside: no edge", "10 inside: no edge, class 2", "10 inside: filled in an earlier round", "10 vacant: outside of the map",
              "10 vacant: hole", "10 not vacant"]
    for where in ("sides", "corners"):
        names.append(f"10 {where}, case 1: all four")
        names += [f"10 {where}, case 2: {there}" for there in ("ab", "abc", "abd", "cd", "acd", "bcd")]
        names += [f"10 {where}, case 3: {there}" for there in ("ac", "ad", "bc", "bd")]
        names += [f"10 {where}, case 4: {there}" for there in "abcd"]
    names += ["10 sides, case 5: none, some not vacant", "10 corners, case 5: none"]
    names += ["10 mean of two, odd sum", "10 mean of two, odd negative sum", "10 mean of four, half",
              "10 mean of four, a quarter up or down"]
    names += ["10 bullet hole in round 0", "10 bullet hole in a later round", "10 bullet hole in the last round",
              "10 hole left for the next round"]
    names.append("10 fill mode none")
    for fill_mode in FILL_MODES[1:]:
        names += [f"10 fill mode {fill_mode}, known, class {klass}" for klass in (GALPIXEL, JUST_UNOBSCURED, DEBRIS)]
        names.append(f"10 fill mode {fill_mode}, not known")
    names += ["10 extend: left is farther", "10 extend: right is farther", "10 extend: equal depths, left",
              "10 extend: only left", "10 extend: only right", "10 extend: row empty, before"]
    names += ["11 edge map made", "11 no edge map", "11 not inside: no edge map", "11 frame counter wraps"]
    names += ["16 not inside: foreign", "16 not vacant: foreign", "16 shown: nothing, the base's cell",
              "16 shown: what was filled, before a galpixel", "16 shown by depth", "16 shown by layer", "16 shown: the base",
              "16 shown: another layer", "16 shown: where the base has nothing",
              "16 stationary-source: lost, but stored", "16 stationary-source: discarded, but stored", "16 stationary-source: displacement clamped",
              "16 hole stays in its layer", "16 bullet hole in another layer", "16 layer whose holes all stay",
              "16 hole of the base under another layer"]
    names += ["14 no mask", "14 mask ends before the cell", "14 class 1, bit set", "14 class 1, bit not set",
              "14 bit of a cell of another class", "14 no depth field", "14 down 0", "14 down > 0",
              "14 depth of the background", "14 no depth of the background", "14 quad without an edge map",
              "14 no quad: no edge", "14 no quad: a corner is empty", "14 quad, several edges"]
    names += [f"14 quad, edge at corner {corner} alone" for corner in range(4)]
    names += ["14 quad not stretched", "14 quad stretched: columns", "14 quad stretched: rows",
              "14 quad stretched: both", "14 quad stretched: just so", "14 quad torn: columns", "14 quad torn: rows",
              "14 quad torn: both",
              "14 quad torn: just so", "14 quad is a line", "14 quad with a corner outside of the map",
              "14 hull: on a line between corners", "14 hull: between all lines", "14 hull: in the box alone",
              "14 hole deepened", "14 hole as deep as its quad"]
    names += [f"14 level 0, class {klass}" for klass in range(4)]
    names += ["14 mean, half, tie 0", "14 mean, half, tie 1",
              "14 source: first of several"]
    names += [f"14 gamma {gamma}" for gamma in GAMMAS]
    names += ["14 gamma 1/2, rounds up", "14 gamma 1, at least 1", "14 pull, one cell", "14 pull, one row",
              "14 pull, one column", "14 pull: nearer, counts with 0", "14 pull: nearer by the threshold",
              "14 pull: nearer by less", "14 pull: nothing counts", "14 pull: nothing there"]
    names += [f"14 sample of {', '.join(some)}" for number in range(1, 5) for some in combinations(SAMPLED, number)]
    names += ["14 sample: cell does not exist", "14 sample: validity 0", "14 sample: nearer",
              "14 sample: nearer by the threshold", "14 push: full validity stays", "14 push: takes the sample",
              "14 push: no sample, nothing", "14 push: no sample, stays", "14 push: mean, of itself most",
              "14 push: mean, halves", "14 push: mean, of the sample most", "14 hole takes colour and motion",
              "14 hole takes colour alone", "14 hole without a sample", "14 map of one cell"]
    names += [f"15 noise by {scale}{coloured}" for scale in NOISE_FACTORS for coloured in ("", ", coloured")]
    names += ["15 level clamped", "15 response known", "15 response not known: validity",
              "15 response not known: depth", "15 detail, moved", "15 detail, not moved", "15 a single cell",
              "15 L is top", "15 L below top", "15 no sample of tones", "15 no sample of statistics",
              "15 cell takes a mean", "15 cell takes the sum"]
    names += ["17 frames above 255", "17 separation above 2^30", "17 tears count", "17 tears do not count",
              "17 surfaces let through", "17 surfaces not let through", "17 body of class 3"]
    names += [f"17 border {border}" for border in BORDERS]
    names += [f"17 body of class {klass}" for klass in (GALPIXEL, JUST_UNOBSCURED, DEBRIS)]
    names += ["17 no frames", "17 equal motion", "17 velocity clamped at the lowest",
              "17 velocity clamped at the highest", "17 farthest ahead on the way", "17 farthest ahead at last",
              "17 farthest ahead at first", "17 ahead, up > 0", "17 ahead, up 0", "17 part just so", "17 do not part",
              "17 ahead by less than nothing", "17 ahead by whole cells", "17 ahead rounded up"]
    names += [f"17 slack{zero} {field} acceleration" for zero in ("", " 0") for field in ("with", "without")]
    names += ["17 not of one surface, just so", "17 of one surface, parts", "17 of one surface, does not part"]
    names += [f"17 opens along {along}, {how}" for along in "xy" for how in ("tears", "farther", "nearer", "equal")]
    names += [f"17 opens at the border, {side}" for side in SIDES]
    names += [f"17 saturated {how}" for how in ("along", "onwards", "backwards")]
    names += ["17 equal keys block nothing", "17 not far enough to be blocked"]
    names += [f"17 blocked by {how} alone" for how in ("gap", "closer", "onwards", "backwards")]
    names += [f"17 blocked to {side}" for side in SIDES]
    names += ["17 extent of several pairs", "17 class 3 covers itself"]
    names += [f"17 spread {side}{what}" for side in SIDES for what in (" goes on", " ends", ": blocked")]
    names += ["17 spread: blocked to another side", "17 spread: 127 stays", "17 spread: its own is larger"]
    names += ["17 all covered", "17 some covered", "17 none covered"]
    names += ["18 empty stays, whatever its tag", "18 another tag stays"]
    names += [f"18 class {klass} of the tag is removed" for klass in (GALPIXEL, JUST_UNOBSCURED, DEBRIS)]
    names += ["18 a missed step", "18 nothing in a cell of the rectangle", "18 takes the rendering's tag",
              "18 lost on the way", "18 of equals the one that was there", "18 behind what was there",
              "18 of several equals the first", "18 of several the nearest", "18 replaces what was there",
              "18 into an empty cell"]
    names += ["20 part without an offset field", "20 part, f < 8", "20 part, f = 8", "20 part, f > 8, half",
              "20 part, f > 8, rounds up", "20 part, f > 8, rounds down", "20 part, f > 8, half a cell",
              "20 outside of the map", "20 beside the margin", "20 do not join: depth", "20 join, just so",
              "20 join, depths differ", "20 join, classes differ", "20 do not join: class 3"]
    names += [f"20 parts in {name} {how}" for name in "xy"
              for how in ("not alike", "not alike, just so", "alike, just so")]
    names += [f"20 {what}, {how}" for what in ("bilinear corner", "bilinear", "silhouette")
              for how in ("just below half", "half", "rounds up", "rounds down")]
    names += [f"20 bilinear, {how}" for how in ("both axes", "corner not joined", "x alone", "y alone", "nothing")]
    names += [f"20 bilinear from {where}" for where in ("the left", "the right", "above", "below")]
    names += [f"20 class {one} covers class {other}" for one in range(EMPTY) for other in range(EMPTY)]
    names += ["20 just does not cover"]
    names += [f"20 silhouette, {side} {how}{shown}" for side in SIDES for how in ("covers the cell", "is covered")
              for shown in ("", ", but not shown")]
    names += ["20 silhouette alone", "20 several silhouettes", "20 silhouette over bilinear"]
    names += ["20 depths", "20 no depth field", "20 threshold 0", "20 threshold above 0"]
    names += [f"20 colour {name}" for name in FORMATS]
    names += [f"20 shown, class {klass}" for klass in range(4)]
    names += ["21 no depth field", "21 depth below 15 bits", "21 depth above 15 bits",
              "21 one layer", "21 several layers", "21 a layer with fewer columns",
              "21 rim without two neighbours opposite", "21 rims mixed", "21 rims not mixed: too few",
              "21 rims not mixed: as many inside", "21 threshold above 2^31 - 1", "21 E is 2^15",
              "21 with sub-cell scan-out", "21 without sub-cell scan-out"]
    names += [f"21 class {klass} is no sample" for klass in (JUST_UNOBSCURED, DEBRIS, EMPTY)]
    names += [f"21 no step only by the difference {which}{just}" for which in ("of the pair", "before", "after")
              for just in ("", ", just so")]
    names += ["21 step without a sample before", "21 step without a sample after", "21 several fields step",
              "21 not linked, neither ends"]
    for side in ("right", "below"):
        names.append(f"21 linked with {side}")
        names += [f"21 only the {field} steps, {side}" for field in ("depth", "velocity_x", "velocity_y")]
        names += [f"21 not linked with {side}, the {which} ends" for which in ("first", "second")]
    names.append("21 no quad only for the fourth sample")
    names += [f"21 displacement in {name} clamped at the {end}" for name in "xy" for end in ("lowest", "highest")]
    names += ["21 part without an offset field"]
    names += [f"21 part with {b} bits, {how}" for b in (4, 5) for how in ("f < b", "f = b", "f > b", "f > b, half")]
    names += ["21 depth of a point is at most 2^15 - 2",
              "21 entries by depth", "21 entries by kind",
              "21 entries by number", "21 entries by number, of several layers"]
    names += [f"21 point off the grid, {side}" for side in SIDES]
    names += ["21 quad not stretched", "21 quad not stretched, just so", "21 quad tries 4 columns or rows",
              "21 reciprocal, k above 7", "21 reciprocal, k is 7", "21 reciprocal, k below 7",
              "21 cell of a quad is off the grid", "21 cell not in a quad", "21 cell not in a quad only by u",
              "21 cell not in a quad only by v", "21 residual in a quad at least 0", "21 residual in a quad at most 15",
              "21 quad gives entries", "21 quad gives no entry"]
    names += [f"21 quad stretched only by {which}{negative}" for which in ("a_x", "a_y", "b_x", "b_y")
              for negative in ("", ", negative")]
    names += [f"21 quad tries none only for its {which}" for which in ("columns", "rows", "area")]
    names += [f"21 just {within} a quad, {end}" for within in ("within", "not within") for end in ("low", "high")]
    names += ["21 not joined: layers", "21 not joined: columns", "21 not joined: rows",
              "21 not joined: columns and rows", "21 not joined: links", "21 joined: one side",
              "21 joined: round a corner", "21 joined: two on a line"]
    names += [f"21 crack: {why}" for why in
              ("off the grid", "a neighbour without an entry", "just not behind", "behind one alone",
               "residual clamped")]
    names += ["21 crack (%d, %d): %s" % (*t, which) for t in WAYS for which in ("F", "G", "equal, F")]
    names += ["21 crack both ways, equal", "21 crack both ways, (1, 0)", "21 crack both ways, (0, 1)",
              "21 crack in an empty cell", "21 crack over an entry"]
    names += [f"21 mixed: {what}" for what in
              ("not nearer now", "beside the border", "nearer beside it", "none beside it",
               "not nearer beside it", "nothing opposite", "too little", "too much", "the other side",
               "an eighth, just so", "all, just so", "sum 0")]
    names += [f"21 mixed with {side}" for side in SIDES]
    names += ["21 mixed, resampled", "21 mixed, not resampled"]
    names += [f"21 colour from {side}" for side in SIDES]
    names += ["21 colour: not linked", "21 colour: no fourth, x alone", "21 colour: no fourth, y alone",
              "21 colour: no fourth, equal", "21 colour: fourth by both", "21 colour: fourth by A alone",
              "21 colour: fourth by B alone", "21 colour: all of a neighbour"]
    names += [f"21 {what}, {how}" for what in ("colour", "silhouette") for how in ("half", "rounds up", "rounds down")]
    names += ["21 fill none", "21 fill extend, class 3: stored", "21 fill extend, class 3 in the run",
              "21 fill extend: no entry in the row", "21 fill extend: only left", "21 fill extend: only right",
              "21 fill extend: equal depths, left", "21 fill extend: left is farther",
              "21 fill extend: right is farther"]
    names += [f"21 fill hold, class {klass}: stored" for klass in range(4)]
    names += ["21 inpainted: a cell of class 3 is known", "21 inpainted: a hole", "21 inpainted by push-pull",
              "21 inpainted by metamers"]
    names += [f"21 reach: from the sample {side}" for side in SIDES]
    names += ["21 reach of another sample", "21 reach of another sample, moved across"]
    names += ["21 reach: beyond 8, not linked", "21 reach: does not end"]
    names += [f"21 silhouette, {side} {how}{shown}" for side in SIDES for how in ("is behind", "is in front")
              for shown in ("", ", but not shown")]
    names += ["21 silhouette: just not nearer", "21 silhouette beside a hole", "21 silhouette alone",
              "21 several silhouettes"]
    return names


RULES = rule_names()

RULES_BEYOND_VECTORS = [
    "2 design numbers refused", "2 derived with acceleration", "2 derived without acceleration",
    "2 derived width below 1 refused", "2 luminosity_int raised to 1", "2 budget or layout refused", "6 grid refused",
    "8 default threshold a power of 2", "8 default threshold 1",
    *(f"9 from 8-bit to {name}" for name in FORMATS), *(f"9 shown from {name}" for name in FORMATS),
    "12 loaded as it is", "12 clamped at the lowest", "12 clamped at the highest", "12 clamped and counted",
    "12 absent field forgets",
    "14 depth of class 3 is 0",     # after a frame it is 0 already
    "17 default with a depth", "17 default without a depth",
]
