"""Robots from the files of others: URDF and MJCF, alone or in a zip with their meshes.

From a file to a robot, one step a module: `upload` (what was sent) -> `xml` (well-formed and
harmless) -> `urdf`, `mjcf` (what MuJoCo needs of it) -> `source` (MuJoCo's model) -> `tree` (which
joints are the four legs') -> `frame`, `leg` (in the side view) -> `lump`, `shapes`, `motors`
(masses, outlines, limits) -> `assemble` (the document) -> `verify` (against MuJoCo's model).
`read` does all of that in this process, `bounded` in one that has limits.
"""
