"""Write words and phones as a TextGrid, as Praat has it."""

from data_example.generator import spoken


def text(phones, duration_s):
    """Return the text of a TextGrid with the tiers words and phones.

    Parameters
    ----------
    phones : list of spoken.Phone, in order, on the clock of the sound
    duration_s : float, of the sound
    """
    tiers = {
        "words": _filled(spoken.words(phones), duration_s, ""),
        "phones": _filled([(p.name, p.start, p.end) for p in phones], duration_s, "pau"),
    }
    lines = ['File type = "ooTextFile"', 'Object class = "TextGrid"', "", "xmin = 0"]
    lines += [f"xmax = {duration_s:.4f}", "tiers? <exists>", f"size = {len(tiers)}", "item []:"]
    for number, (name, intervals) in enumerate(tiers.items(), start=1):
        lines += [f"    item [{number}]:", '        class = "IntervalTier"']
        lines += [
            f'        name = "{name}"',
            "        xmin = 0",
            f"        xmax = {duration_s:.4f}",
        ]
        lines += [f"        intervals: size = {len(intervals)}"]
        for count, (label, start, end) in enumerate(intervals, start=1):
            lines += [f"        intervals [{count}]:", f"            xmin = {start:.4f}"]
            lines += [f"            xmax = {end:.4f}", f'            text = "{label}"']
    return "\n".join(lines) + "\n"


def _filled(intervals, duration_s, pause):
    """Return intervals without holes from 0 to the end; holes are pauses, and pauses join."""
    result, at = [], 0.0
    for label, start, end in [*intervals, (pause, duration_s, duration_s)]:
        for name, first, last in ((pause, at, start), (label or pause, start, end)):
            if last - first < 1e-6:
                continue
            if result and result[-1][0] == name == pause:
                result[-1] = (pause, result[-1][1], last)
            else:
                result.append((name, first, last))
        at = end
    return result
