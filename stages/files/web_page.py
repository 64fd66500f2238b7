"""Web pages that stand alone: Jinja2 templates with pictures and drawings inside the page."""

import base64
from pathlib import Path

import cv2
import jinja2
import numpy as np

from stages.files import atomic

JPEG_QUALITY = 85


def write(path: str | Path, template: str | Path, context: dict) -> None:
    """Fill a template, a name that the context lacks being an error, and write the page."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(Path(template).parent),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    page = environment.get_template(Path(template).name).render(context)
    with atomic.replacing(path) as temporary:
        temporary.write_text(page, encoding="utf-8")


def picture(image: np.ndarray) -> str:
    """Return an (H, W, 3) uint8 RGB array as the `src` of an `<img>`."""
    _, jpeg = cv2.imencode(
        ".jpg", cv2.cvtColor(image, cv2.COLOR_RGB2BGR), [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY]
    )
    return "data:image/jpeg;base64," + base64.b64encode(jpeg.tobytes()).decode()
