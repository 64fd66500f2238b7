from stages import write_report

TEMPLATE = "stages/templates/report.html"


def report(tmp_path, caplog):
    caplog.clear()
    with caplog.at_level("INFO"):
        write_report.main(
            [
                *("--results", str(tmp_path / "results"), "--logs", str(tmp_path / "logs")),
                *("--shots", "ada/day/rom", "ada/day/talk", "--basis", "rom"),
                *("--takes", "rom/fox", "talk/fox", "--template", TEMPLATE),
                *("--report", str(tmp_path / "results/report/index.html")),
            ]
        )
    return [record.message for record in caplog.records]


def log(tmp_path, stage, place, text):
    path = tmp_path / "logs" / stage / f"{place}.log"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def finish(tmp_path, *takes):
    for take in takes:
        folder = tmp_path / "results/takes" / take
        folder.mkdir(parents=True)
        (folder / "preview.mp4").touch()


def test_closes_with_the_count_of_takes_and_the_page(tmp_path, caplog):
    finish(tmp_path, "rom/fox")
    lines = report(tmp_path, caplog)
    assert lines[0] == "not made yet: run keyface"
    assert lines[-1].startswith("1 of 2 takes are finished, see ")


def test_a_take_older_than_a_fault_is_not_finished(tmp_path, caplog):
    finish(tmp_path, "rom/fox", "talk/fox")
    assert report(tmp_path, caplog)[-1].startswith("2 of 2")
    log(tmp_path, "track_video", "talk", "error: talk.mp4: no such film\n")
    lines = report(tmp_path, caplog)
    assert "out of date, made by an earlier run: track_video: talk.mp4: no such film" in lines
    assert lines[-1].startswith("1 of 2")
    log(tmp_path, "track_video", "rom", "error: rom.mp4: no such film\n")
    assert report(tmp_path, caplog)[-1].startswith("0 of 2")


def test_a_fault_of_the_proposals_stops_no_take(tmp_path, caplog):
    finish(tmp_path, "rom/fox", "talk/fox")
    log(tmp_path, "propose_labels", "day", "error: labels.csv: is empty\n")
    lines = report(tmp_path, caplog)
    assert lines[-2] == "propose_labels: labels.csv: is empty"
    assert lines[-1].startswith("2 of 2")
    page = (tmp_path / "results/report/index.html").read_text()
    assert "propose_labels: labels.csv: is empty" in page


def test_a_page_of_references_that_have_failed_since_is_left_out(tmp_path, caplog):
    finish(tmp_path, "rom/fox")
    page = tmp_path / "results/cast/ada/fox/references/index.html"
    page.parent.mkdir(parents=True)
    page.touch()
    log(tmp_path, "select_references", "ada/fox", "error: channels.tsv: no such table\n")
    lines = report(tmp_path, caplog)
    assert "select_references: channels.tsv: no such table" in lines
    assert "cast/ada/fox" not in (tmp_path / "results/report/index.html").read_text()
