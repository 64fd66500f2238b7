import pytest

from stages.files import atomic_folder


def fill(path, text):
    with atomic_folder.replacing(path) as folder:
        (folder / "a.txt").write_text(text)


def test_a_folder_appears_whole_and_replaces_the_one_before(tmp_path):
    path = tmp_path / "deep" / "folder"
    fill(path, "1")
    (path / "old.txt").write_text("old")
    fill(path, "2")
    assert [(file.name, file.read_text()) for file in path.iterdir()] == [("a.txt", "2")]
    assert [entry.name for entry in path.parent.iterdir()] == ["folder"]


def test_a_failure_leaves_what_was_there(tmp_path):
    path = tmp_path / "folder"
    fill(path, "1")

    def fail():
        with atomic_folder.replacing(path) as folder:
            (folder / "a.txt").write_text("2")
            raise RuntimeError

    with pytest.raises(RuntimeError):
        fail()
    assert (path / "a.txt").read_text() == "1"
    assert [entry.name for entry in tmp_path.iterdir()] == ["folder"]
