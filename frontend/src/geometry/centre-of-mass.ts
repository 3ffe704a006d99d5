/** The whole robot's centre of mass for a pose, from the masses in its file. */

import type { SentRobot, Vec2 } from "../api/types";
import { type Frame, robotShape, skeleton } from "./robot";

type Link = SentRobot["thigh"];

/** In the link's frame, which hangs down from its upper joint [m]; a number is a share of its length. */
function ownCentre({ com, length }: Link): Vec2 {
  return Array.isArray(com) ? [com[0]!, com[1]!] : [0, -(com as number) * length];
}

/** Mass centre of a link between its joints [m]. */
function linkCentre(link: Link, upper: Vec2, lower: Vec2): Vec2 {
  const [u, v] = ownCentre(link);
  const [dx, dz] = [lower[0] - upper[0], lower[1] - upper[1]];
  const [along, across] = [-v / link.length, u / link.length];
  return [upper[0] + along * dx - across * dz, upper[1] + along * dz + across * dx];
}

/** Where the robot's centre of mass is, pose by pose [m]. */
export function centreOfMass(file: SentRobot): (frame: Frame) => Vec2 {
  const shape = robotShape(file);
  const rear = file.rear;
  const links: [Link, Link][] = [
    [file.thigh, file.calf],
    [rear?.thigh ?? file.thigh, rear?.calf ?? file.calf],
  ];
  const wheels = [file.wheel.mass, (rear?.wheel ?? file.wheel).mass];
  const bodyCentre = file.trunk.com ?? [0, 0, 0];
  return (frame) => {
    const { legs } = skeleton(shape, frame);
    const [c, s] = [Math.cos(frame.pitch), Math.sin(frame.pitch)];
    const sum: [number, number, number] = [0, 0, 0];
    const add = (mass: number, [x, z]: Vec2) => {
      sum[0] += mass;
      sum[1] += mass * x;
      sum[2] += mass * z;
    };
    const onTrunk = (u: number, v: number): Vec2 => [
      frame.x + u * c + v * s,
      frame.z - u * s + v * c,
    ];
    add(file.trunk.mass, onTrunk(bodyCentre[0]!, bodyCentre[2]!));
    if (shape.payload) add(shape.payload.mass, onTrunk(...shape.payload.place));
    legs.forEach(([hip, knee, wheel], k) => {
      const [thigh, calf] = links[k]!;
      add(2 * thigh.mass, linkCentre(thigh, hip!, knee!));
      add(2 * calf.mass, linkCentre(calf, knee!, wheel!));
      add(2 * wheels[k]!, wheel!);
    });
    return [sum[1] / sum[0], sum[2] / sum[0]];
  };
}
