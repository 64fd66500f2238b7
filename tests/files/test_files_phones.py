import re
from pathlib import Path

import pocketsphinx
import pytest

from stages.files import errors, mouth_cues, phones, transcript, visemes, word_times

TABLE = Path(__file__).parents[2] / "stages" / "tables" / "visemes.tsv"
# Deng et al. 2006, table 1, row by row as printed
PRINTED = """
pau | b p m | k g ng
ae ax ah aa | f v | ch sh jh
ao y iy ih ay aw | ow oy | n d t l
ey eh el em en er | th dh | s z zh
r | w uw uh | hh
"""


def printed_groups():
    return [group.split() for group in re.split(r"[|\n]", PRINTED.strip())]


def test_the_table_holds_the_papers_fifteen_groups():
    table = visemes.read(TABLE, "deng2006")
    groups = printed_groups()
    assert len(groups) == 15
    for group in groups:
        assert {table[phone] for phone in group} == {"_".join(group)}
    assert {viseme for viseme in table.values() if viseme} == {"_".join(g) for g in groups}
    assert table["spn"] == ""


def test_the_table_holds_every_phone_of_the_dictionary():
    table = visemes.read(TABLE, "deng2006")
    dictionary = Path(pocketsphinx.get_model_path("en-us/cmudict-en-us.dict"))
    lines = dictionary.read_text(encoding="utf-8").splitlines()
    emitted = {visemes.name_of(phone) for line in lines for phone in line.split()[1:]}
    assert len(emitted) == 39
    assert all(table[phone] for phone in emitted)


def test_names_drop_stress_and_case():
    labels = ["AH0", "ah1", "EY2", "hh", " B ", "", "sil", "ax-h"]
    assert [visemes.name_of(label) for label in labels] == [
        "ah", "ah", "ey", "hh", "b", "pau", "sil", "ax-h",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("phone\tdeng2006\npau\tpau\nb\tx\nb\ty\n", r"line 4: phone 'b' stands twice"),
        ("phone\tdeng2006\npau\tpau\nAH0\tx\n", r"line 3: 'AH0' must be lower case"),
        ("phone\tdeng2006\nb\tx\n", r"lacks a viseme for 'pau'"),
        ("phone\tother\npau\tx\n", r"unknown column 'other'"),
    ],
)
def test_a_bad_table_is_named(tmp_path, text, message):
    path = tmp_path / "visemes.tsv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(errors.InputError, match=rf"visemes\.tsv: .*{message}"):
        visemes.read(path, "deng2006")


def test_phones_come_back(tmp_path):
    rows = [
        phones.Phone(-0.25, 0.5, "pau", "pau"),
        phones.Phone(0.5, 0.625, "b", "b_p_m", "boy", -1.5),
        phones.Phone(0.625, 1.0, "", "rhubarb_A"),
    ]
    path = tmp_path / "phones.parquet"
    phones.write(path, rows, {"scheme": "deng2006"}, [])
    read = phones.read(path)
    assert [row[:5] for row in read] == [row[:5] for row in rows]
    assert read[1].score == -1.5 and read[0].score != read[0].score
    before = path.read_bytes()
    phones.write(path, rows, {"scheme": "deng2006"}, [])
    assert path.read_bytes() == before


CUES = [(0.0, 0.25, "X"), (0.25, 0.5, "D"), (0.5, 1.0, "G")]
RHUBARB = {
    "cues.tsv": "0.00\tX\n0.25\tD\n0.50\tG\n1.00\tX\n",
    "cues.json": '{"metadata": {"soundFile": "a.wav", "duration": 1.0}, "mouthCues": ['
    '{"start": 0.0, "end": 0.25, "value": "X"}, {"start": 0.25, "end": 0.5, "value": "D"},'
    '{"start": 0.5, "end": 1.0, "value": "G"}]}',
    "cues.xml": '<?xml version="1.0" encoding="utf-8"?>\n<rhubarbResult><metadata/><mouthCues>'
    '<mouthCue start="0.00" end="0.25">X</mouthCue><mouthCue start="0.25" end="0.50">D</mouthCue>'
    '<mouthCue start="0.50" end="1.00">G</mouthCue></mouthCues></rhubarbResult>',
}


@pytest.mark.parametrize("name", RHUBARB)
def test_mouth_cues_are_read_in_every_layout(tmp_path, name):
    path = tmp_path / name
    path.write_text(RHUBARB[name], encoding="utf-8")
    assert [tuple(cue) for cue in mouth_cues.read(path)] == CUES


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.tsv", "0.00\tX\n0.25\tQ\n0.5\tX\n", r"'Q' at 0\.25 s is no mouth shape"),
        ("a.tsv", "0.00\tX\n", r"has no two lines"),
        ("a.tsv", "0.5\tX\n0.25\tB\n1\tX\n", r"shape X spans 0\.5 to 0\.25 s"),
        ("a.tsv", "0.00 X\n0.5 B\n", r"holds no mouth cues of Rhubarb"),
        ("a.json", RHUBARB["cues.json"][:-20], r"holds no mouth cues of Rhubarb"),
        ("a.json", '{"mouthCues": []}', r"holds no mouth cue"),
        ("a.json", '{"mouthCues": [{"start": 0}]}', r"holds no mouth cues of Rhubarb"),
        ("a.xml", RHUBARB["cues.xml"][:-20], r"holds no mouth cues of Rhubarb"),
        ("a.xml", "<other/>", r"holds no mouth cue"),
    ],
)
def test_bad_mouth_cues_are_named(tmp_path, name, text, message):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    with pytest.raises(errors.InputError, match=rf"{re.escape(name)}: .*{message}"):
        mouth_cues.read(path)


def test_word_times_are_in_grids_unit(tmp_path):
    path = tmp_path / "a.align"
    path.write_text("0 23750 sil\n23750 29500 Bin\n29500 30000 sp\n34000 35500 at\n", "utf-8")
    assert [tuple(span) for span in word_times.read(path)] == [
        (0.95, 1.18, "bin"),
        (1.36, 1.42, "at"),
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("0 10 bin\n5 20 blue\n", r"line 2: 'blue' starts before 'bin' ends"),
        ("0 10 bin\n20 20 blue\n", r"line 2: 'blue' ends before it starts"),
        ("0 10 bin\n20 blue\n", r"line 2 is '20 blue': write start, end"),
        ("0 10 bin\n20 x blue\n", r"line 2 is '20 x blue'"),
        ("0 10 sil\n", r"holds no word"),
        ("", r"is empty"),
    ],
)
def test_bad_word_times_are_named(tmp_path, text, message):
    path = tmp_path / "a.align"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(errors.InputError, match=rf"a\.align: {message}"):
        word_times.read(path)


def test_a_transcript_is_words_without_punctuation(tmp_path):
    path = tmp_path / "a.txt"
    text = "\ufeff\u201cDon\u2019t [laughs] re-enter,\u201d she said\u2014twice (low)\r\n7 Times!"
    path.write_text(text, encoding="utf-8")
    spoken = ["don't", "re", "enter", "she", "said", "twice", "7", "times"]
    assert transcript.read(path) == spoken
    path.write_text(text.removeprefix("\ufeff"), encoding="utf-16")
    assert transcript.read(path) == spoken


def test_a_bad_transcript_is_named(tmp_path):
    path = tmp_path / "a.txt"
    with pytest.raises(errors.InputError, match=r"a\.txt: no such file"):
        transcript.read(path)
    for data, message in (
        (b"", "is empty"),
        (b"[coughs]\n", "holds no word"),
        ("Sch\u00f6n".encode("latin-1"), "is no UTF-8 text at byte 3"),
        ("hello".encode("utf-16-le"), "UTF-16 without its mark"),
    ):
        path.write_bytes(data)
        with pytest.raises(errors.InputError, match=message):
            transcript.read(path)
