"""Colours of pictures and the light that they stand for (IEC 61966-2-1)."""

import numpy as np


def linear(colours: np.ndarray) -> np.ndarray:
    """Return the light of sRGB colours, an array of any shape in 0..1."""
    return np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)


def encoded(light: np.ndarray) -> np.ndarray:
    """Return the sRGB colours of light, an array of any shape in 0..1."""
    return np.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)
