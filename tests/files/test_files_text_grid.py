import codecs
import re
from pathlib import Path

import pytest
from praatio import textgrid

from stages.files import errors, known_phones, text_grid, visemes

TABLE = Path(__file__).parents[2] / "stages" / "tables" / "visemes.tsv"
PHONES = [
    (0.0, 0.25, ""),
    (0.25, 0.375, "B"),
    (0.375, 0.625, "OY1"),
    (0.625, 0.75, "sil"),
    (0.75, 1.0, "spn"),
    (1.0, 1.5, ""),
]
WORDS = [(0.0, 0.25, ""), (0.25, 0.625, "boy"), (0.625, 0.75, ""), (0.75, 1.0, 'a "word"'),
         (1.0, 1.5, "")]  # fmt: skip
FORMATS = ["long_textgrid", "short_textgrid", "textgrid_json", "json"]


def saved(path, layout="long_textgrid", **tiers):
    grid = textgrid.Textgrid()
    for name, entries in (tiers or {"words": WORDS, "phones": PHONES}).items():
        grid.addTier(textgrid.IntervalTier(name, entries, 0, 1.5))
    grid.save(str(path), format=layout, includeBlankSpaces=True)
    return path


@pytest.mark.parametrize("layout", FORMATS)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_every_layout_and_encoding_comes_back(tmp_path, layout, encoding):
    path = saved(tmp_path / "a.TextGrid", layout)
    path.write_text(path.read_text(encoding="utf-8"), encoding=encoding)
    found = text_grid.read(path)
    assert [interval[:3] for interval in found] == PHONES
    assert [interval.word for interval in found] == ["", "boy", "boy", "", 'a "word"', ""]


def test_big_endian_and_windows_line_ends(tmp_path):
    path = saved(tmp_path / "a.TextGrid")
    text = path.read_text(encoding="utf-8").replace("\n", "\r\n")
    path.write_bytes(codecs.BOM_UTF16_BE + text.encode("utf-16-be"))
    assert [interval[:3] for interval in text_grid.read(path)] == PHONES


@pytest.mark.parametrize("name", ["a.TextGrid", "a.json"])
def test_labels_become_phones_and_visemes(tmp_path, name):
    layout = "json" if name.endswith("json") else "short_textgrid"
    rows = known_phones.read(saved(tmp_path / name, layout), visemes.read(TABLE, "deng2006"))
    assert [row[2:5] for row in rows] == [
        ("pau", "pau", ""),
        ("b", "b_p_m", "boy"),
        ("oy", "ow_oy", "boy"),
        ("pau", "pau", ""),
        ("spn", "", 'a "word"'),
        ("pau", "pau", ""),
    ]
    assert all(row.score != row.score for row in rows)


def test_the_only_speaker_with_phones_is_taken(tmp_path):
    silent = [(0.0, 1.5, "")]
    speakers = {"Mia - words": WORDS, "Mia - phones": PHONES, "Bob - phones": silent}
    found = text_grid.read(saved(tmp_path / "a.TextGrid", **speakers))
    assert [interval.label for interval in found] == [label for *_, label in PHONES]
    assert found[1].word == "boy"
    both = speakers | {"Bob - phones": PHONES}
    with pytest.raises(errors.InputError, match=r"several speakers \(mia - phones; bob - phones\)"):
        text_grid.read(saved(tmp_path / "a.TextGrid", **both))
    chosen = both | {"phones": PHONES}
    assert text_grid.read(saved(tmp_path / "a.TextGrid", **chosen))[1].label == "B"


def test_a_grid_without_phones_names_its_tiers(tmp_path):
    path = saved(tmp_path / "a.TextGrid", segments=PHONES, words=WORDS)
    with pytest.raises(errors.InputError, match=r"no tier 'phones'.*'segments', 'words'"):
        text_grid.read(path)


@pytest.mark.parametrize("layout", FORMATS)
def test_a_grid_that_is_cut_short_is_refused_wherever_it_ends(tmp_path, layout):
    path = saved(tmp_path / "a.TextGrid", layout)
    data = path.read_text(encoding="utf-8").rstrip()
    for kept in range(0, len(data) - 8, 5):
        path.write_text(data[:kept], encoding="utf-8")
        with pytest.raises(errors.InputError, match=r"a\.TextGrid: "):
            text_grid.read(path)


def test_bad_grids_are_named(tmp_path):
    path = saved(tmp_path / "a.TextGrid")
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("xmin = 0.625", "xmin = 0.5"), encoding="utf-8")
    with pytest.raises(errors.InputError, match=r"tier 'phones': 'sil' at 0\.5 s starts before"):
        text_grid.read(path)
    path.write_text(text.replace("xmax = 0.375", "xmax = 0.25"), encoding="utf-8")
    with pytest.raises(errors.InputError, match=r"'B' spans 0\.25 to 0\.25 s"):
        text_grid.read(path)
    path.write_text(text.replace('"words"', '"phones"'), encoding="utf-8")
    with pytest.raises(errors.InputError, match=r"two tiers are named 'phones'"):
        text_grid.read(path)
    path.write_text("RIFF nothing of the kind", encoding="utf-8")
    with pytest.raises(errors.InputError, match=r"is no TextGrid"):
        text_grid.read(path)
    path.write_bytes(text.replace("boy", "Sch\u00f6n").encode("latin-1"))
    with pytest.raises(errors.InputError, match=r"is no UTF-8 text"):
        text_grid.read(path)


def test_unknown_phones_are_all_named(tmp_path):
    odd = [(0.0, 0.5, "\u0251"), (0.5, 1.0, "B"), (1.0, 1.5, "QQ")]
    path = saved(tmp_path / "a.TextGrid", phones=odd)
    message = r"a\.TextGrid: the table of visemes lacks the phones qq, \u0251: "
    with pytest.raises(errors.InputError, match=message):
        known_phones.read(path, visemes.read(TABLE, "deng2006"))
    with pytest.raises(errors.InputError, match=re.escape("ends in '.lab'")):
        known_phones.read(tmp_path / "a.lab", {})


@pytest.mark.parametrize("text", ["5", "null", '["mouthCues"]'])
def test_json_without_an_object_is_no_file_of_phones(tmp_path, text):
    (tmp_path / "a.json").write_text(text)
    with pytest.raises(errors.InputError, match=r"a\.json: is no TextGrid"):
        known_phones.read(tmp_path / "a.json", {})
