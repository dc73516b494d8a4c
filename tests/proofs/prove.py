"""Proofs about the step kernel with a bit-vector solver.

    python3 prove.py [--quick] [VECTORS]

1. Drift: over all velocities and accelerations of the full width, in each of the first `tau_prop` frames, the rounding drift is at
   most the certified bound; and the bound less one is refuted, so that it is tight.
2. Nothing wraps: over all states of a component, every intermediate word of a step is the exact number, and the state after the
   step is within its fields again. By induction nothing wraps in any number of frames.
3. The kernel that was proved is the engine's: it computes the golden vectors of VECTORS, where given.

`--quick` proves the paper's example alone. Ends with 1 if anything is not as it should be.
"""

import argparse
import json
import sys
import time
from pathlib import Path

from bitwuzla import Bitwuzla, Kind, Option, Options, Result, TermManager

from kernel import Component, Numbers, Terms, clamp, step

PAPER = Component("paper, tau_prop 16", 4, 10, 7, 8, 7)

# Component, frames, and for each rounding the drift that is certified, in units of the last bit of 2v + a.
DRIFTS = [
    (PAPER, 16, {"truncate": 224, "nearest": 128, "low-discrepancy": 64, "searched": 23}),
    (
        Component("paper, tau_prop 8", 3, 10, 5, 8, 5),
        8,
        {"truncate": 48, "nearest": 32, "low-discrepancy": 16, "searched": 8},
    ),
    (
        Component("paper, tau_prop 32", 5, 10, 9, 8, 9),
        32,
        {"truncate": 960, "nearest": 512, "low-discrepancy": 256, "searched": 77},
    ),
]

# Between them every relation of the three fractions, and the widest fields that the arithmetic carries.
WRAPS = [
    PAPER,
    Component("velocity only, 320 px", 4, 7, 4, 0, 0),
    Component("position finer than its step", 7, 6, 4, 4, 2),
    Component("acceleration coarser than velocity", 3, 6, 5, 4, 3),
    Component("no fraction at all", 0, 3, 0, 2, 0),
    Component("the widest fields", 16, 14, 16, 14, 16),
    Component("the widest velocity", 0, 30, 0, 30, 0),
    Component("the most dropped bits", 0, 2, 28, 2, 28),
    Component("the highest lift", 16, 15, 0, 15, 0),
]

# Components of the depth, with the fraction that the depth field leaves them, and the bits of that field.
DEPTHS = [
    (Component("depth of the paper's example", 10, 10, 7, 8, 7), 20),
    (Component("the deepest depth", 16, 14, 16, 14, 16), 28),
    (Component("the deepest depth without a fraction", 0, 2, 28, 2, 28), 28),
]


def tables(spec):
    """The threshold tables of the specification."""
    rows = spec.read_text().split("The tables:")[1].split("\n\n")[1].splitlines()[2:]
    cells = [row.split("|") for row in rows]
    return {int(cell[1]): [int(entry) for entry in cell[2].split(",")] for cell in cells}


class Drift:
    """The drift of one component over its frames, over free full-width velocity and acceleration."""

    def __init__(self, component, frames, rounding, tables):
        self.manager = TermManager()
        self.component, self.frames, self.rounding, self.tables = component, frames, rounding, tables
        # Wide enough for the sum of all frames' errors.
        self.words = Terms(self.manager, component.down + frames.bit_length() + 2)
        self.velocity = self.manager.mk_const(self.manager.mk_bv_sort(component.velocity_bits), "v")
        self.acceleration = self.manager.mk_const(self.manager.mk_bv_sort(component.acceleration_bits), "a")
        self.phase = self.manager.mk_const(self.manager.mk_bv_sort(component.down), "phase")

    def low(self, term, bits):
        """The low `down` bits of a full-width word."""
        return self.manager.mk_term(Kind.BV_EXTRACT, [term], [bits - 1, 0])

    def threshold(self, frame):
        """The frame's threshold as `down` bits; from a free phase of the counter where the bound holds from any."""
        down = self.component.down
        sort = self.manager.mk_bv_sort(down)
        value = {"truncate": 0, "nearest": 1 << (down - 1)}.get(self.rounding)
        if self.rounding == "searched":
            value = self.tables[down][frame % (1 << down)]
        if value is not None:
            return self.manager.mk_bv_value(sort, value)
        counter = self.manager.mk_term(
            Kind.BV_ADD, [self.phase, self.manager.mk_bv_value(sort, frame % (1 << down))]
        )
        bits = [self.manager.mk_term(Kind.BV_EXTRACT, [counter], [bit, bit]) for bit in range(down)]
        return self.manager.mk_term(Kind.BV_CONCAT, bits)

    def by_frame(self):
        """The drift after each frame: the sum of `t - (u + t) mod 2^down`, `u` the low bits of `2v + a`."""
        down, m = self.component.down, self.manager
        assert self.component.acceleration_up == 0
        v, a = self.low(self.velocity, down), self.low(self.acceleration, down)
        twice = m.mk_term(Kind.BV_ADD, [a, a])
        u = m.mk_term(Kind.BV_ADD, [m.mk_term(Kind.BV_ADD, [v, v]), a])
        drift = self.words.constant(0)
        extend = self.words.width - down
        drifts = []
        for frame in range(self.frames):
            t = self.threshold(frame)
            rest = m.mk_term(Kind.BV_ADD, [u, t])
            wide = [m.mk_term(Kind.BV_ZERO_EXTEND, [term], [extend]) for term in (t, rest)]
            drift = self.words.add(drift, self.words.sub(*wide))
            drifts.append(drift)
            u = m.mk_term(Kind.BV_ADD, [u, twice])
        return drifts

    def exceeds(self, bound):
        """Whether some state drifts by more than `bound` in some frame; a witness if so."""
        solver = Bitwuzla(self.manager, options())
        beyond = []
        for drift in self.by_frame():
            beyond.append(self.words.smaller(self.words.constant(bound), drift))
            beyond.append(self.words.smaller(drift, self.words.constant(-bound)))
        solver.assert_formula(self.manager.mk_term(Kind.OR, beyond))
        result = solver.check_sat()
        if result == Result.SAT:
            return True, [solver.get_value(term).value(10) for term in (self.velocity, self.acceleration)]
        return result != Result.UNSAT, None


def options():
    options = Options()
    options.set(Option.PRODUCE_MODELS, True)
    return options


def one_step_is_what_drifts(component):
    """The error of one step of the 32-bit kernel is `t - (u + t) mod 2^down` for every state: what links 1 to the kernel."""
    manager = TermManager()
    words = Terms(manager)

    def free(name, bits, kind):
        return manager.mk_term(kind, [manager.mk_const(manager.mk_bv_sort(bits), name)], [words.width - bits])

    v = free("v", component.velocity_bits, Kind.BV_SIGN_EXTEND)
    a = free("a", component.acceleration_bits, Kind.BV_SIGN_EXTEND)
    t = free("t", component.down, Kind.BV_ZERO_EXTEND)
    made = step(words, component, t, words.constant(0), v, a)
    error = words.sub(words.left(made["dropped"], component.down), made["total"])
    mask = words.constant((1 << component.down) - 1)
    rest = manager.mk_term(Kind.BV_AND, [words.add(made["total"], t), mask])
    same = manager.mk_term(Kind.EQUAL, [error, words.sub(t, rest)])
    solver = Bitwuzla(manager, options())
    solver.assert_formula(manager.mk_term(Kind.NOT, [same]))
    return solver.check_sat() == Result.UNSAT


def nothing_wraps(component, word=32, depth_bits=None):
    """Every word of a step is the exact number, and what is stored again fits its field.

    With `depth_bits` the position is an unsigned depth of that width, which is clamped and does not snap to a cell.
    """
    manager = TermManager()
    narrow, exact = Terms(manager, word), Terms(manager, 2 * word)
    free = {
        "r": manager.mk_const(manager.mk_bv_sort(depth_bits or max(1, component.position_frac)), "r"),
        "v": manager.mk_const(manager.mk_bv_sort(component.velocity_bits), "v"),
        "a": manager.mk_const(manager.mk_bv_sort(max(1, component.acceleration_bits)), "a"),
        "t": manager.mk_const(manager.mk_bv_sort(max(1, component.down)), "t"),
    }
    widths = {
        "r": depth_bits or component.position_frac,
        "v": component.velocity_bits,
        "a": component.acceleration_bits,
        "t": component.down,
    }

    def state(words):
        def word_of(name, signed):
            if not widths[name]:
                return words.constant(0)
            kind = Kind.BV_SIGN_EXTEND if signed else Kind.BV_ZERO_EXTEND
            return manager.mk_term(kind, [free[name]], [words.width - widths[name]])

        return [word_of("t", False), word_of("r", depth_bits is None), word_of("v", True), word_of("a", True)]

    # The same fields, once as words of the engine and once as words of twice the width, in which nothing can wrap.
    small, large = (step(words, component, *state(words)) for words in (narrow, exact))
    fields = {"velocity": (-(1 << (component.velocity_bits - 1)), (1 << (component.velocity_bits - 1)) - 1)}
    if depth_bits is None:
        half = (1 << component.position_frac) >> 1
        fields["offset"] = (-half, max(0, half - 1))
    else:
        for words, made in ((narrow, small), (exact, large)):
            for name in ("rounded", "cells", "offset"):
                del made[name]
            made["depth"] = clamp(words, made["position"], 0, (1 << depth_bits) - 1)
        fields["depth"] = (0, (1 << depth_bits) - 1)
    wrong = []
    for name, term in small.items():
        extended = manager.mk_term(Kind.BV_SIGN_EXTEND, [term], [word])
        wrong.append(manager.mk_term(Kind.DISTINCT, [extended, large[name]]))
    for name, (low, high) in fields.items():
        wrong.append(exact.smaller(large[name], exact.constant(low)))
        wrong.append(exact.smaller(exact.constant(high), large[name]))
    solver = Bitwuzla(manager, options())
    solver.assert_formula(manager.mk_term(Kind.OR, wrong))
    return solver.check_sat() == Result.UNSAT


def numbers_agree(vectors, tables):
    """The kernel over numbers computes every golden step; how many it computed."""
    cases = [case for case in json.loads((vectors / "manifest.json").read_text())["cases"] if case["kind"] == "step"]
    compared = 0
    for entry in cases:
        case = json.loads((vectors / entry["name"] / "case.json").read_text())
        component = Component(case["name"], **case["component"])
        for (frame, r, v, a), result in zip(case["steps"], case["results"]):
            t = number_threshold(case["rounding"], frame, component.down, tables)
            made = step(Numbers(), component, t, r, v, a)
            names = ("position", "cells", "offset", "velocity")
            if [made[name] for name in names] + [int(made["velocity"] != made["faster"])] != result:
                sys.exit(f"{case['name']}: frame {frame}, r {r}, v {v}, a {a}: {made} is not {result}")
            compared += 1
    return compared


def number_threshold(rounding, frame, down, tables):
    if down == 0 or rounding == "truncate":
        return 0
    if rounding == "nearest":
        return 1 << (down - 1)
    if rounding == "searched" and down in tables:
        return tables[down][frame % (1 << down)]
    return int(format(frame % (1 << down), f"0{down}b")[::-1], 2)


class Ledger:
    """Says each result as it comes, and remembers what failed."""

    def __init__(self):
        self.failed = 0

    def entry(self, what, good, started):
        self.failed += not good
        print(f"{'proved' if good else 'FAILED'}  {time.monotonic() - started:6.2f} s  {what}", flush=True)


def main():
    parser = argparse.ArgumentParser(description="Proofs about the step kernel.")
    parser.add_argument("--quick", action="store_true", help="the paper's example alone")
    parser.add_argument("vectors", nargs="?", type=Path, help="a folder that `galpix vectors` wrote")
    arguments = parser.parse_args()
    spec = Path(__file__).resolve().parents[2] / "docs" / "spec.md"
    threshold_tables = tables(spec)
    ledger = Ledger()
    for component, frames, bounds in DRIFTS[:1] if arguments.quick else DRIFTS:
        started = time.monotonic()
        good = one_step_is_what_drifts(component)
        ledger.entry(f"{component.name}: the error of a step is t - (u + t) mod 2^{component.down}", good, started)
        for rounding, bound in bounds.items():
            drift = Drift(component, frames, rounding, threshold_tables)
            started = time.monotonic()
            exceeded, _ = drift.exceeds(bound)
            pixels = bound / 2 ** (component.position_frac + component.down)
            pairs = f"2^{component.velocity_bits + component.acceleration_bits}"
            what = f"{component.name}, {rounding}: {frames} frames, all {pairs} (v, a): drift <= {bound} = {pixels:.4f} px"
            ledger.entry(what, not exceeded, started)
            started = time.monotonic()
            exceeded, witness = drift.exceeds(bound - 1)
            what = f"{component.name}, {rounding}: drift <= {bound - 1} is refuted by (v, a) = {witness}"
            ledger.entry(what, exceeded and witness is not None, started)
    for component in WRAPS[:1] if arguments.quick else WRAPS:
        started = time.monotonic()
        ledger.entry(f"{component.name}: nothing wraps, and the state stays within its fields", nothing_wraps(component), started)
    for component, depth_bits in DEPTHS[:1] if arguments.quick else DEPTHS:
        started = time.monotonic()
        what = f"{component.name}, {depth_bits} bits: nothing wraps, and the state stays within its fields"
        ledger.entry(what, nothing_wraps(component, depth_bits=depth_bits), started)
    # The guards themselves: a word too narrow must be found.
    started = time.monotonic()
    narrow = nothing_wraps(PAPER, PAPER.velocity_bits + 1)
    ledger.entry("in words of 18 bits the paper's example does wrap, and that is found", not narrow, started)
    if arguments.vectors:
        started = time.monotonic()
        compared = numbers_agree(arguments.vectors, threshold_tables)
        ledger.entry(f"the kernel that was proved computes {compared} golden steps", compared > 1000, started)
    sys.exit(1 if ledger.failed else 0)


if __name__ == "__main__":
    main()
