"""Sweeps: in one process, in shards, and on two worker processes of which one is killed."""

import json
import os
import signal
import threading
import time

import pytest

import galpix
from conftest import PROJECT

pytest.importorskip("pyarrow", reason="pyarrow is not installed: sweeps are not tested")

from galpix import sweeps
from galpix.sweeps import __main__ as program  # noqa: E402

DATA = PROJECT.parent / "shared/data"
REAL = [DATA / "blender/ball", DATA / "middlebury_stereo/teddy"]
CAPTURES = [PROJECT / "captures/marbles", *(REAL if all(path.exists() for path in REAL) else ["drift", "crossing"])]
BUDGETS = sweeps.grid(
    frames=[2],
    perceptual=[False],
    recog=[4, 8],
    prop=[8, 16, 32, 64, 128],
    rounding=["nearest", "low-discrepancy"],
    fields=["velocity", "full"],
)


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """The whole sweep, in this process."""
    folder = tmp_path_factory.mktemp("alone")
    files = galpix.sweep(CAPTURES, BUDGETS, folder)
    assert len(BUDGETS) == 40 and len(set(files)) == 120
    return folder


def test_what_is_there_is_not_done_twice(alone, monkeypatch):
    before = {file: file.stat().st_mtime_ns for file in alone.iterdir()}
    monkeypatch.setattr(sweeps, "rows", lambda *_: pytest.fail("a task was done again"))
    galpix.sweep(CAPTURES, BUDGETS, alone)
    assert {file: file.stat().st_mtime_ns for file in alone.iterdir()} == before


def test_shards_are_the_whole(alone, tmp_path):
    budgets = BUDGETS[:5]
    parts = [galpix.sweep(["drift"], budgets, tmp_path, shard=(k, 3)) for k in (1, 2, 3)]
    assert [len(part) for part in parts] == [2, 2, 1]
    assert sweeps.read(tmp_path).num_rows == 10
    (tmp_path / "budgets.json").write_text(json.dumps(budgets))
    arguments = ["drift", "--budgets", str(tmp_path / "budgets.json"), "--out", str(tmp_path / "line"), "--shard"]
    for k in (1, 2, 3):
        assert program.main([*arguments, f"{k}/3"]) == 0
    assert sweeps.equal_but_for_times(sweeps.read(tmp_path), sweeps.read(tmp_path / "line"))


def test_two_workers_of_which_one_is_killed(alone, tmp_path):
    """The result is that of one process bit by bit, and a lost worker costs its task only."""
    distributed = pytest.importorskip("distributed", reason="dask is not installed: sweeps on workers are not tested")
    environment = {"RAYON_NUM_THREADS": "1", "PYTHONUNBUFFERED": "1"}
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, env=environment, silence_logs=50
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        pids = client.run(os.getpid)
        assert len(pids) == 2
        killed, done = [], {}

        def kill():
            while len(list(tmp_path.glob("*.parquet"))) < 30:
                time.sleep(0.005)
            done.update({file: file.stat().st_mtime_ns for file in tmp_path.glob("*.parquet")})
            killed.append(len(done))
            os.kill(list(pids.values())[0], signal.SIGKILL)

        killer = threading.Thread(target=kill)
        killer.start()
        files = galpix.sweep(CAPTURES, BUDGETS, tmp_path, client=client)
        killer.join()
        assert 30 <= killed[0] < 120, "the worker was killed after the sweep"
    # What was there when the worker was lost was not done again.
    assert {file: file.stat().st_mtime_ns for file in done} == done
    assert sorted(files) == sorted(str(file) for file in tmp_path.glob("*.parquet")) and len(files) == 120
    assert sweeps.equal_but_for_times(sweeps.read(tmp_path), sweeps.read(alone))


def test_a_difference_in_one_bit_is_noticed(alone):
    import numpy
    import pyarrow

    table = sweeps.read(alone)
    place = table.column_names.index("worst_px")
    values = table.column("worst_px").to_pylist()
    values[17] = float(numpy.nextafter(values[17], 1))
    assert not sweeps.equal_but_for_times(table, table.set_column(place, "worst_px", pyarrow.array(values)))
    times = pyarrow.array([0.0] * table.num_rows)
    place = table.column_names.index("ns_per_galpixel")
    assert sweeps.equal_but_for_times(table, table.set_column(place, "ns_per_galpixel", times))


def test_a_task_that_fails_leaves_no_file(tmp_path):
    with pytest.raises(ValueError, match="prop = 1 extrapolates nothing"):
        galpix.sweep(["drift"], [{"prop": 1}], tmp_path)
    assert not list(tmp_path.iterdir())


def test_duckdb_reads_the_files(alone):
    duckdb = pytest.importorskip("duckdb", reason="duckdb is not installed: its example is not run")
    example = (PROJECT / "python/examples/smallest_budget.sql").read_text()
    rows = duckdb.sql(example.replace("sweep/*.parquet", f"{alone}/*.parquet")).fetchall()
    assert len(rows) == 3
    for _, budget, bits, error in rows:
        assert "recog" in json.loads(budget) and bits > 0 and error <= 0.5


def test_an_identity_is_of_content_and_budget(tmp_path):
    folder = tmp_path / "scene"
    folder.mkdir()
    (folder / "capture.toml").write_text("one")
    first = sweeps.file_name(folder, {"recog": 8})
    assert sweeps.file_name(folder / "capture.toml", {"recog": 8}) == first
    assert sweeps.file_name(folder, {"recog": 4}) != first
    (folder / "capture.toml").write_text("two")
    assert sweeps.file_name(folder, {"recog": 8}) != first


def test_points_of_galpix_error(tmp_path):
    """`points.json` is what `galpix error crossing --quick --frames 2 … --shard 3/3 --json` printed."""
    import pyarrow.parquet

    given = PROJECT / "python/tests/points.json"
    assert program.main(["--points", str(given), str(given), "--out", str(tmp_path / "points.parquet")]) == 0
    table = pyarrow.parquet.read_table(tmp_path / "points.parquet")
    points = json.loads(given.read_text())["sources"][0]["points"]
    assert table.num_rows == 2 * sum(len(point["frames"]) for point in points)
    row = table.to_pylist()[0]
    assert (row["id"], row["lanes"], row["rung"]) == (points[0]["id"], points[0]["lanes"], points[0]["rung"])
    assert row["position_frac"] == points[0]["bits"][0]
    assert row["picture_psnr_db"] == points[0]["frames"][0]["picture"]["psnr_db"]
    with pytest.raises(ValueError, match="the document has no point"):
        sweeps.points({"sources": []})
