import contextlib
import hashlib
import shutil

import conftest
import tiny_show

TAKE = {"smooth_weights": 2, "bake_mesh": 2, "render_preview": 2}


def digests(folder):
    """Return the sha256 of every result but the report, which may name folders' states."""
    files = sorted(p for p in (folder / "results").rglob("*") if p.is_file())
    return {str(p.relative_to(folder)): hashlib.sha256(p.read_bytes()).hexdigest() for p in files}


def edit(path, old, new):
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


def test_a_run_delivers_everything_and_a_second_does_nothing(finished):
    results = finished.folder / "results"
    for shot in "ab":
        take = results / "takes" / shot / "plate"
        names = {"mesh.exr", "mesh.json", "mesh.pc2", "mesh.glb", "preview.mp4"}
        assert names | {"weights.parquet", "weights.csv"} == {p.name for p in take.iterdir()}
    assert (results / "actors/eve/brief/index.html").is_file()
    assert (results / "sessions/s1/label_proposals.tsv").is_file()
    assert "2 of 2 takes are finished" in (results / "report/index.html").read_text()
    second = finished.snakemake()
    assert second.returncode == 0
    assert "Nothing to be done" in second.stdout + second.stderr


def test_one_core_and_another_folder_give_the_same_bytes(finished, tmp_path):
    other = conftest.Show(tmp_path / "elsewhere", finished.checkout)
    tiny_show.build(other.folder)
    run = other.snakemake(cores=1)
    assert run.returncode == 0, run.stderr
    assert digests(other.folder) == digests(finished.folder)


def test_an_edited_sculpt_makes_only_its_character_again(show):
    sculpt = show.folder / "plate/sculpts/mouth/a_f0009.obj"
    edit(sculpt, "v ", "v 0.5")
    made = {"check_sculpts": 1, "assemble_rig": 1, "write_brief": 1} | TAKE
    assert show.would_run() == made


def test_a_removed_sculpt_fails_the_takes_alone_and_is_named(show):
    sculpt = show.folder / "plate/sculpts/mouth/a_f0009.obj"
    kept = sculpt.read_bytes()
    sculpt.unlink()
    run = show.snakemake()
    assert run.returncode == 1
    log = (show.folder / "logs/assemble_rig/eve/plate.log").read_text()
    assert "1 of 8 sculpts missing, the first is plate/sculpts/mouth/a_f0009.obj" in log
    brief = (show.folder / "results/actors/eve/brief/index.html").read_text()
    assert "7 of 8 sculpts present" in brief
    sculpt.write_bytes(kept)
    assert show.snakemake().returncode == 0
    assert "8 of 8" in (show.folder / "results/actors/eve/brief/index.html").read_text()


@contextlib.contextmanager
def added_line(show, line):
    """Add a line to a core file of the checkout for a while."""
    path = show.checkout / "stages/core/planar_motion.py"
    original = path.read_text()
    path.write_text(original + line)
    try:
        yield
    finally:
        path.write_text(original)


def test_touched_footage_and_a_comment_make_nothing_again(show):
    (show.folder / "footage/b.mp4").touch()
    with added_line(show, "# why\n"):
        assert show.would_run() == {}


def test_edited_code_makes_again_what_it_reaches(show):
    made = {"align_head": 2, "fit_pca": 1, "select_key_shapes": 1, "solve_weights": 2}
    made |= {"check_sculpts": 1, "assemble_rig": 1, "write_brief": 1} | TAKE
    with added_line(show, "EDITED = 1\n"):
        assert show.would_run() == made


def test_a_changed_cell_makes_only_what_it_says(show):
    edit(show.folder / "config/cast.tsv", "eve\tplate\t", "eve\tplate\ta")
    assert show.would_run() == {}
    edit(show.folder / "config/characters.tsv", "2 3 0", "2 3 1")
    made = {"assemble_rig": 1, "smooth_weights": 1, "bake_mesh": 1, "render_preview": 1}
    assert show.would_run() == made


def test_an_added_shot_leaves_the_others_alone(show):
    shutil.copy(show.folder / "footage/b.mp4", show.folder / "footage/c.mp4")
    with (show.folder / "config/shots.tsv").open("a") as table:
        table.write("c\ts1\tfootage/c.mp4\t\t\n")
    made = ["track_video", "propose_labels", "merge_capture", "align_head", "solve_weights"]
    made += ["smooth_weights", "bake_mesh", "render_preview"]
    assert show.would_run() == dict.fromkeys(made, 1)


def test_a_lost_film_fails_its_shot_and_leaves_the_rest(show):
    (show.folder / "footage/b.mp4").unlink()
    shutil.rmtree(show.folder / "results/takes")
    run = show.snakemake()
    assert run.returncode == 1
    assert (
        "error: footage/b.mp4: no such film" in (show.folder / "logs/track_video/b.log").read_text()
    )
    assert (show.folder / "results/takes/a/plate/preview.mp4").is_file()
    assert not (show.folder / "results/shots/b/tracked.parquet").exists()
    assert "no such film" in (show.folder / "results/report/index.html").read_text()


def test_a_faulty_table_stops_everything_in_one_line(show):
    edit(show.folder / "config/cast.tsv", "plate", "robot")
    run = show.snakemake()
    assert run.returncode == 1
    lines = [line for line in run.stderr.splitlines() if "robot" in line]
    assert lines == [
        "error: config/cast.tsv: line 2, column character: 'robot' is not in characters.tsv; "
        "add it there or correct the name"
    ]
    assert "Traceback" not in run.stderr
