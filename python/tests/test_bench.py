"""The benchmark: its suite is frozen, its entries see no truth, its figures are the same bits again."""

import json

import numpy as np
import pytest

import galpix
from conftest import PROJECT
from galpix import bench
from galpix.bench import __main__ as program
from galpix.bench import entries, results, scores, suite

FEW = ["--scene", "drift", "--scene", "crossing"]


def test_the_suite_is_the_frozen_one():
    frozen = json.loads(suite._FROZEN.read_text())
    assert suite.freeze() == suite._FROZEN.read_text() and frozen["suite"] == bench.SUITE
    assert [case.name for case in bench.scenes()] == list(suite.SCENES)


def test_a_scene_that_changed_is_refused(monkeypatch, tmp_path):
    other = json.loads(suite._FROZEN.read_text())
    other["scenes"]["drift"] = "0" * 64
    (tmp_path / "suite.json").write_text(json.dumps(other))
    monkeypatch.setattr(suite, "_FROZEN", tmp_path / "suite.json")
    with pytest.raises(ValueError, match="scene `drift` is not the one that galpix-bench-1 was frozen with"):
        list(bench.scenes(["drift"]))


def test_the_same_figures_again(tmp_path):
    files = [tmp_path / "one.jsonl", tmp_path / "other.jsonl"]
    for file in files:
        assert program.main([*FEW, "--entry", "galpix", "--entry", "integer splat", "--out", str(file)]) == 0
    assert files[0].read_bytes() == files[1].read_bytes()
    assert len(files[0].read_text().splitlines()) == 2 * 2 * 6


def test_shards_are_the_whole_and_others_join(tmp_path, capsys):
    picture = {case.name: case.truth(0).picture for case in bench.scenes(["drift", "crossing"])}
    folder = tmp_path / "mine"
    image = pytest.importorskip("PIL.Image", reason="pillow is not installed: folders of PNG files are not tested")
    for name, still in picture.items():
        (folder / name).mkdir(parents=True)
        for frame in (1, 2, 4):
            image.fromarray(still).save(folder / name / f"{frame:04}.png")
    out = tmp_path / "results.jsonl"
    joined = ["--entry", "hold", "--entry", f"mine={folder}", "--entry", "theirs=galpix.bench.entries:hold"]
    for k in (1, 2, 3):
        assert program.main([*FEW, *joined, "--shard", f"{k}/3", "--out", str(out)]) == 0
    rows = bench.read([out])
    assert len(rows) == 2 * (6 + 3 + 6)
    figures = {(row["entry"], row["scene"], row["frame"]): {name: row[name] for name in bench.SCORES} for row in rows}
    for scene in picture:
        for frame in bench.FRAMES:
            assert figures["hold", scene, frame] == figures["theirs", scene, frame]
        # Of frame 3 there is no PNG, so that the change into frame 4 is not known.
        mine = figures["mine", scene, 4]
        assert mine.pop("flicker") is None and figures["hold", scene, 4].pop("flicker") is not None
        assert mine == figures["hold", scene, 4]
    capsys.readouterr()
    page = tmp_path / "page.html"
    assert program.main(["--read", str(out), "--page", str(page), "--measure", "flip"]) == 0
    assert "| mine |" in capsys.readouterr().out and "<svg" in page.read_text()
    assert "http" not in page.read_text()
    pytest.importorskip("pyarrow")
    results.parquet(rows, tmp_path / "rows.parquet")


def test_entries_get_no_truth():
    seen = []

    def predictor(update, frames):
        seen.append((update, frames))
        return {frame: entries.display(update.colour, update) for frame in frames}

    case = next(bench.scenes(["crossing"]))
    rows = list(bench.rows_of(case, [("mine", entries.of_update(predictor))]))
    update, frames = seen[0]
    assert isinstance(update, galpix.Update) and frames == [1, 2, 3, 4, 7, 8, 15, 16, 31, 32]
    assert [row["frame"] for row in rows] == list(bench.FRAMES)


def test_a_perfect_entry_has_perfect_scores():
    case = next(bench.scenes(["ball"]))
    perfect = lambda case, frames: {frame: case.truth(frame).picture for frame in frames}
    for row in bench.rows_of(case, [("truth", perfect)]):
        assert (row["psnr_db"], row["flip"], row["wrong_percent"], row["flicker"]) == (100.0, 0.0, 0.0, 0.0)
        assert row["ssim"] == pytest.approx(1)


@pytest.mark.parametrize("name", ["float nearest", "float bilinear", "integer splat", "galpix", "galpix map, extend"])
def test_whole_motion_of_one_surface_is_exact(name):
    """Every entry that moves pixels moves a picture by whole pixels without error, where the picture is seen."""
    rng = np.random.default_rng(3)
    colour = rng.integers(0, 256, (40, 48, 3), np.uint8)
    shape = colour.shape[:2]
    velocity = np.broadcast_to(np.array([2.0, 1.0, 0.0]), (*shape, 3)).copy()
    update = galpix.Update(
        colour,
        np.full(shape, 0.5),
        velocity,
        np.zeros_like(velocity),
        np.zeros(shape),
        np.ones(shape, np.uint8),
        np.ones(shape, bool),
        (0, 0, 0, 0),
        "z",
    )

    class Source:
        def run(self, frames, prop, **options):
            return galpix.extrapolate(colour, velocity, depth=update.depth, frames=frames, prop=prop, **options)

    class Case:
        source = Source()

        def update(self):
            return update

    for frame, shown in bench.ENTRIES[name](Case(), [1, 3]).items():
        moved = colour[: -1 * frame, : -2 * frame]
        assert (shown[frame:, 2 * frame :] == moved).all(), frame


def test_classes_cover_the_picture_once():
    case = next(bench.scenes(["ball"]))
    uncovered, entered = scores.classes(case, [8])[8]
    assert uncovered.any() and not (uncovered & entered).any()
    reached = case.source.run(frames=8, prop=32, fill="none").reached[7]
    assert (reached == ~(uncovered | entered)).all()


def test_captures_join():
    cases = list(bench.captures([PROJECT / "captures"]))
    assert [case.name for case in cases] == ["marbles"]
    rows = list(bench.rows_of(cases[0], [("galpix", bench.ENTRIES["galpix"]), ("hold", bench.ENTRIES["hold"])]))
    assert {row["frame"] for row in rows} <= set(bench.FRAMES) and len(rows) >= 8
    assert entries.applies("galpix, DDOC", cases[0]) and not entries.applies("galpix", cases[0])


def test_what_cannot_be_used_is_said(tmp_path, capsys):
    (tmp_path / "torn.jsonl").write_text("{}\n")
    for arguments, sentence in [
        (["--entry", "mine"], "`mine` is no entry: give NAME=FOLDER"),
        (["--read", str(tmp_path / "torn.jsonl")], "line 1 of"),
        (["--no-scenes", "--captures", str(tmp_path)], "holds no capture.toml"),
    ]:
        assert program.main(arguments) == 2
        assert sentence in capsys.readouterr().err
    bad = lambda case, frames: {frame: np.zeros((2, 2, 3), np.uint8) for frame in frames}
    with pytest.raises(ValueError, match="entry `bad` made uint8 of shape"):
        list(bench.rows_of(next(bench.scenes(["drift"])), [("bad", bad)]))
