"""One small robot of each kind, read before a process is sealed: modules cannot be loaded later."""

from __future__ import annotations

import io
import zipfile

from .meshes import read_mesh
from .read import read
from .upload import unpack

_LEG = """
<body name="{n}a" pos="{x} {y} 0"><joint name="{n}a" axis="1 0 0"/><geom size=".03"/>
 <body name="{n}t"><joint name="{n}t" axis="0 1 0" range="-2 2"/><geom size=".03"/>
  <body name="{n}c" pos="0 0 -.2"><joint name="{n}c" axis="0 1 0" range="-2 -.5"/><geom size=".02"/>
   <body name="{n}w" pos="0 0 -.2"><joint name="{n}w" axis="0 1 0"/>
    <geom type="cylinder" size=".06 .02" quat="1 1 0 0"/></body></body></body></body>"""
_LEGS = "".join(
    _LEG.format(n=name, x=x, y=y)
    for name, x, y in (("a", 0.2, 0.1), ("b", 0.2, -0.1), ("c", -0.2, 0.1), ("d", -0.2, -0.1))
)
_MJCF = f"""<mujoco><compiler autolimits="true"/><asset><mesh name="m" file="m.obj"/></asset>
<worldbody><body name="base" pos="0 0 1"><freejoint/><geom type="box" size=".2 .1 .05"/>
<geom type="mesh" mesh="m"/>{_LEGS}</body></worldbody></mujoco>"""
_TETRA = "v 0 0 0\nv .1 0 0\nv 0 .1 0\nv 0 0 .1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
_CORNERS = "0 0 0\n0.1 0 0\n0 0.1 0\n0 0 0.1\n"
_FACES = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"
_MESHES = {
    "off": f"OFF\n4 4 0\n{_CORNERS}{_FACES}",
    "ply": "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    f"{_CORNERS}{_FACES}",
    "stl": "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
    "endloop\nendfacet\nendsolid a\n",
}


def rehearse(*, meshes: bool = True) -> None:
    """Read them; without `meshes` only what needs no trimesh, which takes a second to import."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in (("a.xml", _MJCF), ("m.obj", _TETRA), ("ä.obj", _TETRA)):
            archive.writestr(name, text)
    read(unpack(packed.getvalue(), "a.zip"), {})
    for kind, text in _MESHES.items() if meshes else ():
        read_mesh(text.encode(), kind)
