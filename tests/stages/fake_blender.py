"""Stand-ins for what the Blender script uses of bpy and mathutils, with slots or without."""

import types

import numpy as np
from scipy.spatial.transform import Rotation


class Matrix(np.ndarray):
    def __new__(cls, rows):
        return np.array(rows, float).view(cls)

    @classmethod
    def scaling(cls, factor, size):
        return cls(np.diag([factor] * (size - 1) + [1.0]))

    @classmethod
    def moving(cls, shift):
        made = np.eye(4)
        made[:3, 3] = shift
        return cls(made)

    def to_4x4(self):
        made = np.eye(4)
        made[:3, :3] = self
        return Matrix(made)

    def decompose(self):
        size = np.cbrt(np.linalg.det(self[:3, :3]))
        turn = Rotation.from_matrix(np.array(self[:3, :3]) / size).as_quat()
        return np.array(self[:3, 3]), Quaternion(turn[[3, 0, 1, 2]]), np.full(3, size)


# Blender's spellings
Matrix.Scale, Matrix.Translation = Matrix.scaling, Matrix.moving


class Quaternion(np.ndarray):
    def __new__(cls, values):
        return np.array(values, float).view(cls)

    def to_matrix(self):
        return Matrix(Rotation.from_quat(np.roll(np.array(self), -1)).as_matrix())

    def make_compatible(self, other):
        if np.dot(self, other) < 0:
            self *= -1


class Points:
    """Key points of a curve."""

    def __init__(self):
        self.rows = np.zeros((0, 2))

    def clear(self):
        self.rows = np.zeros((0, 2))

    def add(self, count):
        self.rows = np.concatenate([self.rows, np.zeros((count, 2))])

    def foreach_set(self, name, values):
        if name == "co":
            self.rows = np.reshape(np.array(values, float), self.rows.shape)
        else:
            assert (name, set(values), len(values)) == ("interpolation", {1}, len(self.rows))


class Curves(dict):
    def find(self, path, index):
        return self.get((path, index))


class Data:
    """A data block with animation: all its curves, in an action with or without slots."""

    def __init__(self, slotted):
        self.curves = Curves()
        self.animation_data = types.SimpleNamespace(action=types.SimpleNamespace())
        if slotted:
            part = types.SimpleNamespace(fcurves=self.curves)
            strip = types.SimpleNamespace(channelbag=lambda slot: {"mine": part}[slot])
            layer = types.SimpleNamespace(strips=[strip])
            self.animation_data.action.layers = [layer]
            self.animation_data.action_slot = "mine"
        else:
            self.animation_data.action.fcurves = self.curves
        self.id_data = self

    def keyframe_insert(self, path, index, frame):
        self.insert(path, index)

    def insert(self, path, index):
        curve = types.SimpleNamespace(keyframe_points=Points(), update=lambda: None)
        curve.keyframe_points.add(1)
        self.curves.setdefault((path, max(index, 0)), curve)

    def at(self, path, frames, index=0):
        keys = self.curves[path, index].keyframe_points.rows
        return np.interp(frames, keys[:, 0], keys[:, 1])


class Key:
    def __init__(self, name, owner):
        self.name, self.id_data = name, owner
        self.slider_min, self.slider_max = 0.0, 1.0

    def path_from_id(self, path):
        return f'key_blocks["{self.name}"].{path}'

    def keyframe_insert(self, path, index, frame):
        self.id_data.insert(self.path_from_id(path), index)


class Mesh(Data):
    """An object with shape keys and a resting transform."""

    type = "MESH"

    def __init__(self, names, slotted, rest):
        super().__init__(slotted)
        self.name, self.keys, self.properties = "face", Data(slotted), {}
        self.keys.key_blocks = [Key(name, self.keys) for name in names]
        self.data = types.SimpleNamespace(shape_keys=self.keys if names else None)
        self.matrix_basis = Matrix(rest)
        self.modifiers = Modifiers()

    def get(self, name):
        return self.properties.get(name)

    def __setitem__(self, name, value):
        self.properties[name] = value


class Modifiers(dict):
    def new(self, name, kind):
        return self.setdefault(name, types.SimpleNamespace(kind=kind))


def modules(active):
    """Return the modules by name, with one active object."""
    bpy, mathutils = types.ModuleType("bpy"), types.ModuleType("mathutils")
    layer = types.SimpleNamespace(objects=types.SimpleNamespace(active=active))
    scene = types.SimpleNamespace(render=types.SimpleNamespace())
    bpy.context = types.SimpleNamespace(view_layer=layer, scene=scene)
    bpy.path = types.SimpleNamespace(abspath=lambda path: path)
    mathutils.Matrix, mathutils.Quaternion, mathutils.Vector = Matrix, Quaternion, np.array
    return {"bpy": bpy, "mathutils": mathutils}
