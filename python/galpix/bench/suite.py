"""The suite: updates, and the true pictures of later frames."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Optional

import numpy as np

from ..sources import Source, Truth, Update
from ..sources import open as open_source

SUITE = "galpix-bench-1"
"""The version of the suite: other scenes, frames or scores have another one."""

FRAMES = (1, 2, 4, 8, 16, 32)
"""The frames after the update that are scored; the frame before each is made too, for the flicker."""

SCENES = ("drift", "pan", "ramp", "pillars", "crossing", "fovea", "ball", "disc", "sphere", "near-plane")
"""The scenes of the suite. `still` and `hud` are left out: nothing moves, and what is pinned over a picture is no
extrapolation."""

_FROZEN = Path(__file__).with_name("suite-1.json")


@dataclass(frozen=True)
class Case:
    """An update and what came of it."""

    source: Source
    second_order: Optional[bool]
    """Whether velocity and acceleration say all of the motion; None where that is not known, as of a capture."""

    @property
    def name(self) -> str:
        """The scene's or the capture's name."""
        return self.source.name

    def update(self) -> Update:
        """Return what entries get."""
        return self.source.update()

    def frames(self) -> list[int]:
        """Return those of `FRAMES` whose truth is known."""
        known = set(self.source.truth_frames(max(FRAMES)))
        return [frame for frame in FRAMES if frame in known]

    def truth(self, frame: int) -> Truth:
        """Return a true picture, of one of `frames` or of the frame before; frame 0 is the update's.

        Raises ValueError where it is not known.
        """
        if frame == 0:
            update = self.update()
            left, right, top, bottom = update.margin
            rows, columns = update.depth.shape
            return Truth(np.ascontiguousarray(update.colour[top : rows - bottom, left : columns - right]), None)
        truth = self.source.truth(frame)
        if truth is None:
            raise ValueError(f"the true picture of frame {frame} of `{self.name}` is not known")
        return truth

    def digest(self) -> str:
        """Return a hash of the update's colours and of all true pictures that are scored."""
        digest = hashlib.sha256(self.update().colour.tobytes())
        for frame in self.frames():
            truth = self.truth(frame)
            digest.update(truth.picture.tobytes())
            digest.update(b"" if truth.mask is None else truth.mask.tobytes())
        return digest.hexdigest()


def scenes(names: Iterable[str] = SCENES, *, check: bool = True) -> Iterator[Case]:
    """Make the cases of the built-in scenes.

    Raises ValueError if a picture is not the one that the suite was frozen with.

    >>> [case.name for case in scenes(["drift"])]
    ['drift']
    """
    frozen = json.loads(_FROZEN.read_text())["scenes"] if check else {}
    for name in names:
        if name not in SCENES:
            raise ValueError(f"`{name}` is no scene of the suite: give some of {', '.join(SCENES)}")
        source = open_source(name)
        case = Case(source, source.second_order)
        if check and case.digest() != frozen[name]:
            raise ValueError(
                f"scene `{name}` is not the one that {SUITE} was frozen with: its figures cannot stand beside others; "
                "give the suite another version"
            )
        yield case


def captures(folders: Iterable[Path]) -> Iterator[Case]:
    """Make a case of every `capture.toml` below some folders, in the order of their paths."""
    for folder in folders:
        manifests = [folder] if folder.name == "capture.toml" else sorted(Path(folder).rglob("capture.toml"))
        if not manifests:
            raise ValueError(f"`{folder}` holds no capture.toml: give the folder of a capture, or one above it")
        for manifest in manifests:
            case = Case(open_source(manifest), None)
            if case.frames():
                yield case


def freeze() -> str:
    """Return the text of `suite-1.json`: what is frozen when a suite gets its version."""
    hashes = {case.name: case.digest() for case in scenes(check=False)}
    return json.dumps({"suite": SUITE, "frames": FRAMES, "scenes": hashes}, indent=2) + "\n"
