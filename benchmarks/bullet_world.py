"""The robot and the terrain in Bullet, seen as our own MuJoCo model is: qpos, qvel, ctrl.

Made from the URDF that the product exports, with a ball for each wheel as in the MuJoCo model.
What is Bullet's own: its multibody dynamics at 1 ms, contacts by a projected Gauss-Seidel solver
with Coulomb friction. It has no rotor inertia: that is added to the links that the motors turn.
Legs pass each other: whether they touch is not judged.
"""

from __future__ import annotations

import tempfile
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pybullet as bullet
from numpy.typing import NDArray

from stairwright._core import GRAVITY
from stairwright.export.urdf_file import FIXED_FRAMES, robot_urdf
from stairwright.robot.description import JOINTS, LEGS, Robot
from stairwright.robot.mujoco_model import TIMESTEP
from stairwright.robot.mujoco_terrain import TERRAIN_HALF_WIDTH, prisms
from stairwright.terrain.profile import Terrain

Floats = NDArray[np.float64]

_STILL = 0.1  # rad/s from which on a bearing's drag is full
_EXACT = 200  # iterations of the solver at most


class World:
    """One simulation.

    Attributes:
        qpos, qvel: (19,) and (18,) the state in our layout, after `read`.
        ctrl: (12,) torques, handed over by `advance`.
    """

    def __init__(self, robot: Robot, terrain: Terrain, friction: float) -> None:
        self.qpos, self.qvel, self.ctrl = np.zeros(19), np.zeros(18), np.zeros(12)
        self.client = client = bullet.connect(bullet.DIRECT)
        bullet.setGravity(0, 0, -GRAVITY, physicsClientId=client)
        bullet.setPhysicsEngineParameter(
            fixedTimeStep=TIMESTEP,
            numSubSteps=1,
            numSolverIterations=_EXACT,
            solverResidualThreshold=1e-12,
            physicsClientId=client,
        )
        self.ground = [self._prism(outline, friction) for outline in prisms(terrain)]
        self.robot = self._load(robot)
        self._map(robot, friction)
        self.drag = np.array(
            [
                leg.wheel.rolling_resistance * robot.mass * GRAVITY / 4 * leg.wheel.radius
                for leg in (robot.legs[k // 2] for k in range(4))
            ]
        )

    def _prism(self, outline: Floats, friction: float) -> int:
        client = self.client
        (x0, floor), (x1, _), (_, z1), (_, z0) = outline
        if z0 == z1:
            half = [(x1 - x0) / 2, TERRAIN_HALF_WIDTH, (z0 - floor) / 2]
            shape = bullet.createCollisionShape(
                bullet.GEOM_BOX, halfExtents=half, physicsClientId=client
            )
            place = [(x0 + x1) / 2, 0.0, (z0 + floor) / 2]
        else:
            middle = outline.mean(axis=0)
            sides = (-TERRAIN_HALF_WIDTH, TERRAIN_HALF_WIDTH)
            corners = [[x - middle[0], y, z - middle[1]] for y in sides for x, z in outline]
            shape = bullet.createCollisionShape(
                bullet.GEOM_MESH, vertices=corners, physicsClientId=client
            )
            place = [middle[0], 0.0, middle[1]]
        body = bullet.createMultiBody(0, shape, basePosition=place, physicsClientId=client)
        # Friction of two bodies is their product here: the robot's is 1.
        bullet.changeDynamics(body, -1, lateralFriction=friction, physicsClientId=client)
        return int(body)

    def _load(self, robot: Robot) -> int:
        plain = robot.model_copy(update={"joint_names": {}, "joint_frames": {}})
        root = ET.fromstring(robot_urdf(plain))
        for element in list(root):  # frames without mass would weigh 1 kg here
            if {element.get("name"), *(c.get("link") for c in element)} & set(FIXED_FRAMES):
                root.remove(element)
        for link in root.iter("link"):
            name = link.get("name", "")
            leg = robot.legs[0 if name.startswith("F") else 1]
            if name.endswith("wheel"):
                for geometry in link.iter("geometry"):
                    geometry.clear()
                    ET.SubElement(geometry, "sphere", radius=f"{leg.wheel.radius}")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "robot.urdf"
            path.write_bytes(ET.tostring(root))
            flags = bullet.URDF_USE_INERTIA_FROM_FILE
            return int(bullet.loadURDF(str(path), flags=flags, physicsClientId=self.client))

    def _map(self, robot: Robot, friction: float) -> None:
        client, own = self.client, self.robot
        index = {}
        self.names = {-1: "trunk"}
        for k in range(bullet.getNumJoints(own, physicsClientId=client)):
            info = bullet.getJointInfo(own, k, physicsClientId=client)
            index[info[1].decode()] = k
            self.names[k] = info[12].decode()
        self.joints = [index[name] for name in JOINTS]
        self.wheel_links = [index[f"{leg}_wheel"] for leg in LEGS]
        for name, k in zip(JOINTS, self.joints, strict=True):
            leg = robot.legs[0 if name[0] == "F" else 1]
            motor, inertia = (
                getattr(leg, f"{name[3:]}_motor"),
                np.array(getattr(leg, name[3:]).inertia),
            )
            inertia[1] += motor.armature
            bullet.changeDynamics(
                own, k, jointDamping=motor.damping, localInertiaDiagonal=inertia.tolist(),
                physicsClientId=client,
            )  # fmt: skip
            bullet.setJointMotorControl2(
                own, k, bullet.VELOCITY_CONTROL, force=0.0, physicsClientId=client
            )
        bullet.changeDynamics(
            own, -1, linearDamping=0.0, angularDamping=0.0, physicsClientId=client
        )
        for k in self.names:  # in a call of its own: beside dampings it is passed over
            bullet.changeDynamics(own, k, lateralFriction=1.0, physicsClientId=client)
        state = bullet.getDynamicsInfo(own, -1, physicsClientId=client)
        self.base = np.array(state[3])  # of the trunk's mass centre in its frame

    def place(self) -> None:
        """Put the robot where `qpos` is, at rest."""
        turn, client = _rotation(self.qpos[3:7]), self.client
        w, x, y, z = self.qpos[3:7]
        bullet.resetBasePositionAndOrientation(
            self.robot, self.qpos[:3] + turn @ self.base, [x, y, z, w], physicsClientId=client
        )
        for k, angle in zip(self.joints, self.qpos[7:], strict=True):
            bullet.resetJointState(self.robot, k, angle, 0.0, physicsClientId=client)
        self.read()

    def read(self) -> None:
        """Fetch the state."""
        client, own = self.client, self.robot
        place, (x, y, z, w) = bullet.getBasePositionAndOrientation(own, physicsClientId=client)
        moving, spin = bullet.getBaseVelocity(own, physicsClientId=client)
        wxyz = np.array([w, x, y, z])
        self.qpos[3:7] = wxyz * np.copysign(1.0, wxyz @ self.qpos[3:7])
        turn = _rotation(wxyz)
        self.qpos[:3] = np.array(place) - turn @ self.base
        self.qvel[:3] = np.array(moving) - np.cross(spin, turn @ self.base)
        self.qvel[3:6] = turn.T @ np.array(spin)
        states = bullet.getJointStates(own, self.joints, physicsClientId=client)
        self.qpos[7:], self.qvel[6:] = np.array([state[:2] for state in states]).T

    def advance(self, steps: int) -> None:
        """`steps` of physics with the torques of `ctrl`."""
        torques = self.ctrl.copy()
        torques[2::3] -= self.drag * np.clip(self.qvel[8::3] / _STILL, -1.0, 1.0)
        for _ in range(steps):
            bullet.setJointMotorControlArray(
                self.robot, self.joints, bullet.TORQUE_CONTROL, forces=torques.tolist(),
                physicsClientId=self.client,
            )  # fmt: skip
            bullet.stepSimulation(physicsClientId=self.client)
        self.read()

    def loads(self) -> dict[str, float]:
        """Force of the terrain on trunk and links by name [N]; empty when none touches."""
        out: dict[str, float] = {}
        for contact in bullet.getContactPoints(bodyA=self.robot, physicsClientId=self.client):
            name, force = self.names[contact[3]], float(contact[9])
            if not name.endswith("wheel") and contact[2] != self.robot and force > 0.0:
                out[name] = out.get(name, 0.0) + force
        return out

    def wheel_centres(self) -> Floats:
        """(4, 3) in the world [m]."""
        states = bullet.getLinkStates(
            self.robot, self.wheel_links, computeForwardKinematics=True, physicsClientId=self.client
        )
        return np.array([state[4] for state in states])

    def __del__(self) -> None:
        bullet.disconnect(physicsClientId=self.client)


def _rotation(wxyz: Floats) -> Floats:
    w, x, y, z = wxyz
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
