"""The step kernel as 32-bit words, once for a solver and once for numbers.

`Terms` builds bit-vector terms for the solver, `Numbers` computes; `step` is written once over either. What the solver proves
is thereby the same text that `numbers_agree` compares with the golden vectors of the engine.
"""

from dataclasses import dataclass

from bitwuzla import Kind

WORD = 32


@dataclass(frozen=True)
class Component:
    """Widths of a component, and the arithmetic that follows from them (sections 2 and 5 of the specification)."""

    name: str
    position_frac: int
    velocity_int: int
    velocity_frac: int
    acceleration_int: int
    acceleration_frac: int

    @property
    def acceleration_up(self):
        return max(0, self.velocity_frac - self.acceleration_frac)

    @property
    def down(self):
        return max(0, self.velocity_frac + 1 - self.position_frac)

    @property
    def up(self):
        return max(0, self.position_frac - self.velocity_frac - 1)

    @property
    def velocity_bits(self):
        return self.velocity_int + self.velocity_frac

    @property
    def acceleration_bits(self):
        return self.acceleration_int + self.acceleration_frac


class Numbers:
    """Words as Python integers in two's complement."""

    def __init__(self, width=WORD):
        self.width = width

    def wrap(self, value):
        value &= (1 << self.width) - 1
        return value - (1 << self.width) if value >> (self.width - 1) else value

    def constant(self, value):
        return self.wrap(value)

    def add(self, a, b):
        return self.wrap(a + b)

    def sub(self, a, b):
        return self.wrap(a - b)

    def left(self, a, bits):
        return self.wrap(a << bits)

    def right(self, a, bits):
        return a >> bits

    def smaller(self, a, b):
        return a < b

    def choose(self, condition, a, b):
        return a if condition else b


class Terms:
    """Words as terms of a solver."""

    def __init__(self, manager, width=WORD):
        self.manager = manager
        self.width = width
        self.sort = manager.mk_bv_sort(width)

    def constant(self, value):
        return self.manager.mk_bv_value(self.sort, value & ((1 << self.width) - 1))

    def add(self, a, b):
        return self.manager.mk_term(Kind.BV_ADD, [a, b])

    def sub(self, a, b):
        return self.manager.mk_term(Kind.BV_SUB, [a, b])

    def left(self, a, bits):
        return self.manager.mk_term(Kind.BV_SHL, [a, self.constant(bits)])

    def right(self, a, bits):
        return self.manager.mk_term(Kind.BV_ASHR, [a, self.constant(bits)])

    def smaller(self, a, b):
        return self.manager.mk_term(Kind.BV_SLT, [a, b])

    def choose(self, condition, a, b):
        return self.manager.mk_term(Kind.ITE, [condition, a, b])


def clamp(words, value, low, high):
    low, high = words.constant(low), words.constant(high)
    value = words.choose(words.smaller(value, low), low, value)
    return words.choose(words.smaller(high, value), high, value)


def step(words, component, threshold, r, v, a):
    """Section 5: every intermediate word that the engine computes, by name."""
    lifted = words.left(a, component.acceleration_up)
    doubled = words.left(v, 1)
    total = words.add(doubled, lifted)
    raised = words.add(total, threshold)
    dropped = words.right(raised, component.down)
    moved = words.left(dropped, component.up)
    position = words.add(r, moved)
    half = words.constant((1 << component.position_frac) >> 1)
    rounded = words.add(position, half)
    cells = words.right(rounded, component.position_frac)
    offset = words.sub(position, words.left(cells, component.position_frac))
    faster = words.add(v, lifted)
    if component.acceleration_int:
        top = 1 << (component.velocity_bits - 1)
        velocity = clamp(words, faster, -top, top - 1)
    else:
        velocity = v
    return {
        "lifted": lifted,
        "doubled": doubled,
        "total": total,
        "raised": raised,
        "dropped": dropped,
        "moved": moved,
        "position": position,
        "rounded": rounded,
        "cells": cells,
        "offset": offset,
        "faster": faster,
        "velocity": velocity,
    }
