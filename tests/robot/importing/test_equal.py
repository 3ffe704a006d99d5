"""The robot that is made moves and weighs as MuJoCo's model of the file does.

The comparison is its own: it loads the file with MuJoCo, strips what cannot be loaded, and applies
the joint maps that the import reports.
"""

from __future__ import annotations

import os
import xml.etree.ElementTree as ET
from pathlib import Path

import mujoco
import numpy as np
import pytest

from stairwright.robot import kinematics
from stairwright.robot.importing.read import read
from stairwright.robot.importing.report import Imported
from stairwright.robot.importing.upload import Upload
from tests.robot.importing.files import Design, scrambled
from tests.robot.importing.written import mjcf, urdf

LEGS = ("FL", "FR", "RL", "RR")
MAKERS = os.environ.get("STAIRWRIGHT_MAKERS")


def load(text: str) -> mujoco.MjModel:
    """MuJoCo's own model, without looks and meshes."""
    root = ET.fromstring(text)
    for link in root.iter("link"):
        for shown in link.findall("visual"):
            link.remove(shown)
        for inertia in link.findall("inertial/inertia"):
            if float(inertia.get("ixx")) < 1e-20:
                inertia.attrib |= dict.fromkeys(("ixx", "iyy", "izz"), "1e-12")
                inertia.attrib |= dict.fromkeys(("ixy", "ixz", "iyz"), "0")
    spec = mujoco.MjSpec.from_string(ET.tostring(root, encoding="unicode"))
    spec.compiler.fusestatic = False
    for geom in list(spec.geoms):
        if geom.type == mujoco.mjtGeom.mjGEOM_MESH:
            spec.delete(geom)
    for mesh in list(spec.meshes):
        spec.delete(mesh)
    return spec.compile()


def differences(model: mujoco.MjModel, made: Imported, postures: int = 1000) -> tuple[float, ...]:
    """Largest errors: wheels and knees [m], total mass [kg], CoM [m]."""
    robot, data = made.robot, mujoco.MjData(model)
    trunk = 1
    bodies = [b for b in range(1, model.nbody) if model.body_rootid[b] == trunk]
    masses = model.body_mass[bodies]
    rng = np.random.default_rng(5)
    limits = [end for leg in robot.legs for end in (leg.limits.thigh, leg.limits.calf)]
    low, high = np.array(limits).T
    addresses = {
        name: model.jnt_qposadr[model.joint(own.name).id] for name, own in made.joints.items()
    }
    centre, worst = None, np.zeros(2)
    for _ in range(postures):
        q = rng.uniform(low, high)
        data.qpos[:] = model.qpos0
        for name, at in made.locked.items():
            data.qpos[model.jnt_qposadr[model.joint(name).id]] = at
        for name, own in made.joints.items():
            leg, part = name.split("_")
            ours = {"thigh": q[0 if leg[0] == "F" else 2], "calf": q[1 if leg[0] == "F" else 3]}
            theirs = own.sign * (ours.get(part, own.offset) - own.offset)
            data.qpos[addresses[name]] = theirs
        mujoco.mj_kinematics(model, data)
        axes, origin = data.xmat[trunk].reshape(3, 3), data.xpos[trunk]
        anchors = {
            name: ((data.xanchor[model.joint(own.name).id] - origin) @ axes)[[0, 2]]
            for name, own in made.joints.items()
        }
        if centre is None:
            centre = sum(anchors[f"{leg}_thigh"] for leg in LEGS) / 4
        com = ((masses @ data.xipos[bodies] / masses.sum() - origin) @ axes)[[0, 2]]
        zero = np.zeros(())
        frames = kinematics.forward(robot, zero, zero, zero, q)
        for leg in LEGS:
            k = 0 if leg[0] == "F" else 1
            for part, points in (
                ("calf", frames.knees),
                ("wheel", frames.wheels),
                ("thigh", frames.hips),
            ):
                off = np.abs(anchors[f"{leg}_{part}"] - centre - points[k]).max()
                worst[0] = max(worst[0], off)
        ours = kinematics.com(robot, zero, zero, zero, frames)
        worst[1] = max(worst[1], np.abs(com - centre - ours).max())
    return worst[0], abs(masses.sum() - robot.mass), worst[1]


def check(text: str, name: str, postures: int = 1000) -> Imported:
    """Read `text`, and hold it against MuJoCo."""
    made = read(Upload(name, text.encode()), {})
    places, mass, com = differences(load(text), made, postures)
    assert places < 1e-9
    assert mass < 1e-9
    assert com < 1e-6
    return made


@pytest.mark.parametrize("write", [mjcf, urdf])
def test_a_robot_as_makers_write_them(write):
    design = Design()
    made = check(write(design), f"maker.{write.__name__}")
    robot = made.robot
    assert robot.thigh.length == pytest.approx(design.thigh)
    assert robot.calf.length == pytest.approx(design.calf)
    assert robot.wheel.radius == pytest.approx(design.radius)
    for pair in (robot.joints.front, robot.joints.rear):
        assert pair.thigh == pytest.approx(design.thigh_range)
        assert pair.calf == pytest.approx(design.calf_range)
    assert robot.hips.half_track == pytest.approx(0.06 + 0.09 + 0.03)
    assert robot.ros_joints[0] == "FL_thigh_joint"


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(12))
def test_whatever_the_names_signs_and_zero_angles(seed):
    design = scrambled(seed)
    for write in (mjcf, urdf):
        made = check(write(design), f"a.{write.__name__}", postures=100)
        robot = made.robot
        assert robot.joints.rear.calf == pytest.approx(design.calf_range, abs=1e-9)
        assert robot.joints.front.thigh == pytest.approx(design.thigh_range, abs=1e-9)
        for leg in LEGS:
            own = made.joints[f"{leg}_calf"]
            assert own.name == design.joint(leg, "calf")
            assert own.sign * (design.theirs(leg, "calf", -1.3)) + own.offset == pytest.approx(-1.3)


@pytest.mark.skipif(MAKERS is None, reason="STAIRWRIGHT_MAKERS names no folder of makers' files")
@pytest.mark.parametrize("name", ["go2w", "b2w", "M20"])
@pytest.mark.parametrize("kind", ["urdf", "xml"])
def test_makers_files(name, kind):
    check((Path(MAKERS) / f"{name}.{kind}").read_text(), f"{name}.{kind}")
