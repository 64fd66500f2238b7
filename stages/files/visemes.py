"""The table of visemes: which mouth every phone shows, in one column a scheme.

Columns: phone (ARPAbet, lower case, without stress); `deng2006`, the 15 groups of Deng et al.
2006, table 1, each named by its members there; `kholgade2011`, the 12 visemes of Kholgade et al.
2011, named as in the table of extremes (the paper gives their number alone). Not in the former's
table, and added to the group that they look like: sil, sp, h# (silence), bcl, pcl, dcl, tcl, gcl,
kcl (closures of stops), eng, ax-h, ix, ux, axr, dx, nx, wh, hv and q. A blank cell is a phone
whose mouth is not known: spn, a word that the aligner's dictionary lacks.
"""

import re
from pathlib import Path

from stages.files import delimited, errors

SCHEMES = ("deng2006", "kholgade2011")
SILENCE = "pau"
STRESS = re.compile(r"(?<=[a-z])[012]$")


def read(path: str | Path, scheme: str) -> dict[str, str]:
    """Read one scheme of the table, phone -> viseme.

    Raises
    ------
    errors.InputError
        if a phone stands twice or is not in lower case, or silence has no viseme
    """
    others = [name for name in SCHEMES if name != scheme]
    table: dict[str, str] = {}
    for row in delimited.read(path, ["phone", scheme], others):
        phone = row.cells["phone"]
        if phone in table:
            raise errors.InputError(path, f"line {row.line}: phone '{phone}' stands twice")
        if phone != name_of(phone):
            message = f"line {row.line}: '{phone}' must be lower case, without a digit of stress"
            raise errors.InputError(path, message)
        table[phone] = row.cells[scheme]
    if not table.get(SILENCE):
        raise errors.InputError(path, f"lacks a viseme for '{SILENCE}', silence: add its row")
    return table


def name_of(label: str) -> str:
    """Return a label of an aligner as a phone: lower case, stress dropped, blank is silence."""
    return STRESS.sub("", label.strip().lower()) or SILENCE


def look_up(path: str | Path, table: dict[str, str], phones: list[str]) -> list[str]:
    """Return the visemes of phones.

    Parameters
    ----------
    path : the file that names the phones, for the error
    table : phone -> viseme
    phones : their names

    Raises
    ------
    errors.InputError
        naming every phone that the table lacks
    """
    if unknown := sorted(set(phones) - set(table)):
        message = f"the table of visemes lacks the phones {', '.join(unknown)}"
        cure = "align with an ARPAbet dictionary, such as english_us_arpa of MFA, or map them"
        raise errors.InputError(path, f"{message}: {cure}")
    return [table[phone] for phone in phones]
