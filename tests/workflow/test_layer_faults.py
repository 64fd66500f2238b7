"""What is refused of shows of layers: one line with file, place and cure; the rest is finished."""

import re
import shutil

import layer_show
import pytest


@pytest.fixture
def show(layered, tmp_path):
    """Return a finished show that a test may change."""
    return layered.copy(tmp_path / "show")


def faulty_show(show):
    """Add two characters with faulty masks, and lose files of another's take."""
    shutil.copytree(show.folder / "painted", show.folder / "black")
    paint = show.folder / "black/masks.ply"
    paint.write_text(re.sub(r" \d+ 0 0\n", " 0 0 0\n", paint.read_text(), count=1))
    shutil.copytree(show.folder / "plain", show.folder / "unsummed")
    layer_show.edit(show.folder / "unsummed/masks.tsv", "\n3\tmouth\t0.5\n", "\n3\tmouth\t0.7\n")
    characters = show.folder / "config/characters.tsv"
    lines = characters.read_text().splitlines()
    for old, new in (("plain", "unsummed"), ("painted", "black")):
        row = next(line for line in lines if line.startswith(old))
        layer_show.add(characters, row.replace(f"\t{old}\t", f"\t{new}\t").replace(old, new, 1))
        layer_show.add(show.folder / "config/cast.tsv", "eve", new, "markers", "b")
    for name in ("preview.mp4", "layers/speech.csv"):
        (layer_show.take(show, "plain") / name).unlink()


FAULTS = {
    "assemble_poses/eve/black": r"black/masks\.ply: vertex 6 is black, .*: paint it red, .*",
    "assemble_poses/eve/unsummed": r"unsummed/masks\.tsv: vertex 3: .*1\.2.*: correct its rows",
}


def test_faulty_characters_leave_the_others_their_takes(show):
    faulty_show(show)
    run = show.snakemake()
    assert run.returncode == 1
    assert "Traceback" not in run.stderr
    page = (show.folder / "results/report/index.html").read_text()
    for place, pattern in FAULTS.items():
        log = (show.folder / f"logs/{place}.log").read_text()
        lines = log.splitlines()
        assert len(lines) == 1 and re.fullmatch(f"error: {pattern}", lines[0]), log
        assert lines[0].split(":")[1].strip() in page
    assert layer_show.names_in(
        layer_show.take(show, "plain")
    ) > layer_show.TAKE | layer_show.SOLVED | {"layers/speech.csv"}
    assert not (show.folder / "results/cast/eve/black/rig.npz").exists()
    assert not (show.folder / "results/cast/eve/unsummed/rig.npz").exists()


def without(*starts):
    """Return a function that takes rows out of a table."""

    def take_out(text):
        kept = [line for line in text.splitlines(True) if not line.startswith(starts)]
        assert len(kept) < text.count("\n")
        return "".join(kept)

    return take_out


def test_a_pick_that_is_missing_is_named(show):
    table = show.folder / "config/expressions.tsv"
    table.write_text(without("eve\tspeech\tm\t")(table.read_text()))
    target = "results/cast/eve/painted/simplices.npz"
    assert show.snakemake(target).returncode == 1
    log = (show.folder / "logs/assemble_simplices/eve/painted.log").read_text()
    pattern = r"eve has no row for speech m, the closed lips: add it, or set lip_sigma to 0 .*"
    assert re.fullmatch(rf"error: config/expressions\.tsv: {pattern}\n", log), log
    assert not (show.folder / target).exists()


def replaced(old, new):
    """Return a function that changes a cell or row of a table once."""

    def replace(text):
        assert old in text
        return text.replace(old, new, 1)

    return replace


def with_row(*cells):
    """Return a function that adds a row to a table."""
    return lambda text: text + "\t".join(cells) + "\n"


SENSELESS = [
    (
        "cast",
        replaced("eve\tplain\tmarkers", "eve\tplain\tboth"),
        r"config/cast\.tsv: line 2, column points: b has no both points",
    ),
    (
        "characters",
        replaced("\t0\t0\t0\tnone\t\t\t", "\t0\t0\t0\tnone\t\t\tchannels.tsv"),
        r"config/characters\.tsv: line 2, column channels: method layers has channels of its "
        r"delivery_shapes alone; clear the cell",
    ),
    (
        "characters",
        replaced("\t2\tdynamics", "\t9/2\tdynamics"),
        r"config/characters\.tsv: line 3, column tempo: '9/2' is no tempo from 1/4 to 4 such as ",
    ),
    (
        "expressions",
        without("eve\tblink\topen", "eve\tblink\thalf"),
        r"config/expressions\.tsv: line 9: closed is the one extreme of layer blink: pick a ",
    ),
    (
        "expressions",
        replaced("eve\temotion\tsurprise", "eve\temotion\tsurprize"),
        r"config/expressions\.tsv: line 6, column name: emotion has no extreme 'surprize', the ",
    ),
    (
        "directing",
        with_row("painted", "b", "emotion", "angre", "2", "", "", "0.2"),
        r"config/directing\.tsv: line 2, column name: emotion has no 'angre', is it anger\?: ",
    ),
    (
        "directing",
        with_row("painted", "b", "emotion", "anger", "2", "3", "2", "0.2"),
        r"config/directing\.tsv: line 2: the end, 2 s, is not after the start, 3 s: correct ",
    ),
    (
        "directing",
        with_row("painted", "b", "emotion", "anger", "2", "soon", "", "0.2"),
        r"config/directing\.tsv: line 2, column start_s: ",
    ),
]


SENSELESS_NAMES = ("both", "channels", "tempo", "alone", "no name", "no family", "end", "time")


@pytest.mark.parametrize(("table", "change", "pattern"), SENSELESS, ids=SENSELESS_NAMES)
def test_tables_that_make_no_sense_stop_before_any_job(show, table, change, pattern):
    path = show.folder / "config" / f"{table}.tsv"
    path.write_text(change(path.read_text()))
    run = show.snakemake()
    lines = [line for line in run.stderr.splitlines() if line.startswith("error: ")]
    assert run.returncode == 1 and len(lines) == 1, run.stderr
    assert re.match(f"error: {pattern}", lines[0]), lines[0]
    assert "Traceback" not in run.stderr


def test_extremes_are_proposed_before_there_is_any_table(show):
    for name in ("expressions", "actor_masks", "directing"):
        (show.folder / f"config/{name}.tsv").unlink()
    for name in ("cast", "takes", "actors"):
        shutil.rmtree(show.folder / "results" / name)
    assert show.snakemake().returncode == 1
    proposals = show.folder / "results/actors/eve/expressions"
    assert layer_show.names_in(proposals) == {"index.html", "expressions.tsv"}
    log = (show.folder / "logs/assemble_simplices/eve/plain.log").read_text()
    assert re.fullmatch(r"error: config/expressions\.tsv: no such .*\n", log), log
