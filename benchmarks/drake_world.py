"""The robot and the terrain in Drake, seen as our own MuJoCo model is: qpos, qvel, ctrl.

Made from the same documents as the MuJoCo model, by another road: bodies, hinges and shapes of
Drake's MultibodyPlant. What is Drake's own: discrete dynamics at 1 ms, contacts by its solver with
Coulomb friction (a point contact's stiffness and dissipation are given here), capsules and convex
prisms as its geometry engine has them. Legs pass each other: whether they touch is not judged.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from pydrake.common.eigen_geometry import Quaternion
from pydrake.geometry import (
    AddContactMaterial,
    Box,
    Capsule,
    CollisionFilterDeclaration,
    Convex,
    GeometrySet,
    ProximityProperties,
    Sphere,
)
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.plant import (
    AddMultibodyPlantSceneGraph,
    CoulombFriction,
    DiscreteContactApproximation,
)
from pydrake.multibody.tree import (
    FixedOffsetFrame,
    RevoluteJoint,
    SpatialInertia,
    UnitInertia,
)
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from stairwright._core import GRAVITY
from stairwright.robot.description import LEGS, Robot
from stairwright.robot.mujoco_model import TIMESTEP
from stairwright.robot.mujoco_terrain import TERRAIN_HALF_WIDTH, prisms
from stairwright.terrain.profile import Terrain

Floats = NDArray[np.float64]

STIFFNESS = 3e5  # N/m of a point contact: a wheel sinks in by less than 1 mm
DISSIPATION = 10.0  # s/m, Hunt and Crossley
PLATE = 0.005  # m thick: what a slope is made of; thicker ones show beyond its upper end
_STILL = 0.1  # rad/s from which on a bearing's drag is full


class World:
    """One simulation.

    Attributes:
        qpos, qvel: (19,) and (18,) the state in our layout, after `read`.
        ctrl: (12,) torques, handed over by `advance`.
    """

    def __init__(self, robot: Robot, terrain: Terrain, friction: float) -> None:
        self.qpos, self.qvel, self.ctrl = np.zeros(19), np.zeros(18), np.zeros(12)
        self.robot = robot
        builder = DiagramBuilder()
        self.plant, self.scene = AddMultibodyPlantSceneGraph(builder, time_step=TIMESTEP)
        plant = self.plant
        plant.set_discrete_contact_approximation(DiscreteContactApproximation.kLagged)
        plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, -GRAVITY])
        self._surface = ProximityProperties()
        AddContactMaterial(
            dissipation=DISSIPATION,
            point_stiffness=STIFFNESS,
            friction=CoulombFriction(friction, friction),
            properties=self._surface,
        )
        self._add_terrain(terrain)
        self.trunk, self.joints, self.wheels = self._add_robot(robot)
        plant.Finalize()
        self._filter()
        diagram = builder.Build()
        self.simulator = Simulator(diagram)
        self.context = plant.GetMyMutableContextFromRoot(self.simulator.get_mutable_context())
        self.drag = np.array(
            [
                leg.wheel.rolling_resistance * robot.mass * GRAVITY / 4 * leg.wheel.radius
                for leg in (robot.legs[k // 2] for k in range(4))
            ]
        )

    def _add_terrain(self, terrain: Terrain) -> None:
        """Boxes: a column under each stretch; where it slopes a plate and the face at its end.

        A sphere touches a box exactly, a convex hull only to the tolerance of GJK.
        """
        width = 2 * TERRAIN_HALF_WIDTH
        for k, outline in enumerate(prisms(terrain)):
            (x0, floor), (x1, _), (_, z1), (_, z0) = outline
            top = min(z0, z1)
            column = RigidTransform([(x0 + x1) / 2, 0.0, (top + floor) / 2])
            self._add_ground(f"column_{k}", Box(x1 - x0, width, top - floor), column)
            if z0 == z1:
                continue
            angle, length = np.arctan2(z1 - z0, x1 - x0), float(np.hypot(x1 - x0, z1 - z0))
            middle = np.array([(x0 + x1) / 2, 0.0, (z0 + z1) / 2])
            middle += PLATE / 2 * np.array([np.sin(angle), 0.0, -np.cos(angle)])
            slope = RigidTransform(RotationMatrix.MakeYRotation(-angle), middle)
            self._add_ground(f"slope_{k}", Box(length, width, PLATE), slope)
            # The face below its higher end, which a neighbour may leave open.
            rise = abs(z1 - z0) - PLATE * abs(np.tan(angle))
            if rise > 0.0:
                x = x1 - PLATE / 2 if z1 > z0 else x0 + PLATE / 2
                face = RigidTransform([x, 0.0, top + rise / 2])
                self._add_ground(f"face_{k}", Box(PLATE, width, rise), face)

    def _add_ground(self, name: str, shape: Box, place: RigidTransform) -> None:
        world = self.plant.world_body()
        self.plant.RegisterCollisionGeometry(world, place, shape, name, self._surface)

    def _add_robot(self, robot: Robot):
        plant, body = self.plant, robot.body
        trunk = plant.AddRigidBody("trunk", _inertia(body.mass, body.com, body.inertia))
        for k, piece in enumerate(body.outline):
            half = piece.width / 2
            corners = np.array([(x, y, z) for y in (-half, half) for x, z in piece.points])
            shape = Convex(corners.T, f"trunk_{k}")
            plant.RegisterCollisionGeometry(
                trunk, RigidTransform(), shape, f"trunk_{k}", self._surface
            )
        joints, wheels = [], []
        for name in LEGS:
            leg = robot.legs[0 if name[0] == "F" else 1]
            side = 1.0 if name[1] == "L" else -1.0
            parent, place = trunk, [leg.hip[0], side * robot.hips.half_track, leg.hip[1]]
            for part in ("thigh", "calf", "wheel"):
                own = getattr(leg, part)
                com = (0.0, 0.0) if part == "wheel" else own.com
                inertia = _inertia(own.mass, (com[0], 0.0, com[1]), own.inertia)
                link = plant.AddRigidBody(f"{name}_{part}", inertia)
                motor = getattr(leg, f"{part}_motor")
                low, high = (-np.inf, np.inf) if part == "wheel" else getattr(leg.limits, part)
                joint = plant.AddJoint(
                    RevoluteJoint(
                        f"{name}_{part}_joint",
                        _frame(plant, parent, place, f"{name}_{part}_in"),
                        link.body_frame(),
                        [0.0, 1.0, 0.0],
                        low,
                        high,
                        motor.damping,
                    )
                )
                actuator = plant.AddJointActuator(f"{name}_{part}", joint)
                actuator.set_default_rotor_inertia(motor.armature)
                actuator.set_default_gear_ratio(1.0)
                joints.append(joint)
                if part == "wheel":
                    ball = Sphere(own.radius)
                    plant.RegisterCollisionGeometry(
                        link, RigidTransform(), ball, link.name(), self._surface
                    )
                    wheels.append(link)
                    continue
                for k, ((ax, az), (bx, bz), radius) in enumerate(own.capsules):
                    middle, shape = _capsule(ax, az, bx, bz, radius)
                    plant.RegisterCollisionGeometry(
                        link, middle, shape, f"{link.name()}_{k}", self._surface
                    )
                parent, place = link, [0.0, 0.0, -own.length]
        return trunk, joints, wheels

    def _filter(self) -> None:
        """Nothing of the robot touches the robot."""
        plant = self.plant
        bodies = [plant.get_body(i) for i in plant.GetBodyIndices(self.trunk.model_instance())]
        own = [b for b in bodies if b.name() != "world"]
        shapes = GeometrySet([g for b in own for g in plant.GetCollisionGeometriesForBody(b)])
        apart = CollisionFilterDeclaration().ExcludeWithin(shapes)
        self.scene.collision_filter_manager().Apply(apart)

    def place(self) -> None:
        """Put the robot where `qpos` is, at rest."""
        pose = RigidTransform(RotationMatrix(Quaternion(self.qpos[3:7])), self.qpos[:3])
        self.plant.SetFreeBodyPose(self.context, self.trunk, pose)
        for joint, angle in zip(self.joints, self.qpos[7:], strict=True):
            joint.set_angle(self.context, angle)
            joint.set_angular_rate(self.context, 0.0)
        self._torques(np.zeros(12))
        self.simulator.Initialize()
        self.read()

    def depth(self) -> float:
        """How far the deepest shape is inside the ground [m]."""
        found = self._contacts()
        deepest = [
            found.point_pair_contact_info(i).point_pair().depth
            for i in range(found.num_point_pair_contacts())
        ]
        return max(deepest, default=0.0)

    def read(self) -> None:
        """Fetch the state."""
        context = self.context
        pose = self.plant.GetFreeBodyPose(context, self.trunk)
        moving = self.plant.EvalBodySpatialVelocityInWorld(context, self.trunk)
        turn = pose.rotation().matrix()
        wxyz = pose.rotation().ToQuaternion().wxyz()
        self.qpos[:3] = pose.translation()
        self.qpos[3:7] = wxyz * np.copysign(1.0, wxyz @ self.qpos[3:7])
        self.qpos[7:] = [joint.get_angle(context) for joint in self.joints]
        self.qvel[:3] = moving.translational()
        self.qvel[3:6] = turn.T @ moving.rotational()
        self.qvel[6:] = [joint.get_angular_rate(context) for joint in self.joints]

    def _torques(self, torques: Floats) -> None:
        self.plant.get_actuation_input_port().FixValue(self.context, torques)

    def advance(self, steps: int) -> None:
        """`steps` of physics with the torques of `ctrl`."""
        torques = self.ctrl.copy()
        torques[2::3] -= self.drag * np.clip(self.qvel[8::3] / _STILL, -1.0, 1.0)
        self._torques(torques)
        now = self.simulator.get_context().get_time()
        self.simulator.AdvanceTo(now + steps * TIMESTEP)
        self.read()

    def _contacts(self):
        return self.plant.get_contact_results_output_port().Eval(self.context)

    def loads(self) -> dict[str, float]:
        """Force of the terrain on trunk and links by name [N]; empty when none touches."""
        found, out = self._contacts(), {}
        for i in range(found.num_point_pair_contacts()):
            info = found.point_pair_contact_info(i)
            pair = (
                self.plant.get_body(info.bodyA_index()),
                self.plant.get_body(info.bodyB_index()),
            )
            (name,) = (body.name() for body in pair if body.name() != "world")
            if not name.endswith("wheel"):
                out[name] = out.get(name, 0.0) + float(np.linalg.norm(info.contact_force()))
        return out

    def wheel_centres(self) -> Floats:
        """(4, 3) in the world [m]."""
        pose = self.plant.EvalBodyPoseInWorld
        return np.array([pose(self.context, wheel).translation() for wheel in self.wheels])


def _inertia(mass: float, com, inertia) -> SpatialInertia:
    about_com = SpatialInertia(mass, [0.0, 0.0, 0.0], UnitInertia(*(np.array(inertia) / mass)))
    return about_com.Shift(-np.array(com))


def _frame(plant, body, place, name: str):
    return plant.AddFrame(FixedOffsetFrame(name, body.body_frame(), RigidTransform(place)))


def _capsule(ax: float, az: float, bx: float, bz: float, radius: float):
    """Pose and shape; Drake's lies along z."""
    angle = np.arctan2(ax - bx, az - bz)
    middle = RigidTransform(
        RotationMatrix.MakeYRotation(angle), [(ax + bx) / 2, 0.0, (az + bz) / 2]
    )
    return middle, Capsule(radius, float(np.hypot(bx - ax, bz - az)))
