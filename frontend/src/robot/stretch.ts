/** What changes along with a dimension: shapes stretch, masses stay, moments follow. */

import type { RobotDocument } from "../api/types";

type Link = RobotDocument["thigh"];
type Moments = number[];

/**
 * Moments of a body that is stretched along its axes, or made heavier: the second moments of its
 * mass grow with the squares. [kg m²]
 */
function stretched(moments: Moments, by: [number, number, number], mass: number): Moments {
  const [a, b, c] = moments as [number, number, number];
  const x = (mass * by[0] ** 2 * (b + c - a)) / 2;
  const y = (mass * by[1] ** 2 * (a + c - b)) / 2;
  const z = (mass * by[2] ** 2 * (a + b - c)) / 2;
  return [y + z, x + z, x + y];
}

/** A longer link: its mass centre and its bars keep their shares of the length. */
export function longer(link: Link, length: number): Link {
  const ratio = length / link.length;
  const along = (p: number[]): [number, number] => [p[0]!, p[1]! * ratio];
  return {
    ...link,
    length,
    com: typeof link.com === "number" ? link.com : along(link.com),
    inertia: stretched(link.inertia, [1, 1, ratio], 1) as Link["inertia"],
    ...(link.shape?.length
      ? { shape: link.shape.map((c) => ({ ...c, start: along(c.start), end: along(c.end) })) }
      : {}),
  };
}

/** A heavier part of the same shape. */
export function heavier<T extends { mass: number; inertia: number[] }>(part: T, mass: number): T {
  return { ...part, mass, inertia: stretched(part.inertia, [1, 1, 1], mass / part.mass) };
}

export function bigger(wheel: RobotDocument["wheel"], radius: number): RobotDocument["wheel"] {
  const ratio = radius / wheel.radius;
  const inertia = stretched(wheel.inertia, [ratio, 1, ratio], 1);
  return { ...wheel, radius, inertia: inertia as typeof wheel.inertia };
}

/** A trunk of another length, width or height; its outline stretches along. */
export function resized(file: RobotDocument, axis: 0 | 1 | 2, size: number): RobotDocument {
  const trunk = file.trunk;
  const ratio = size / trunk.size[axis]!;
  const by: [number, number, number] = [1, 1, 1];
  by[axis] = ratio;
  const outline = (trunk.outline ?? []).map((piece) => ({
    width: piece.width * by[1],
    points: piece.points.map(([x, z]) => [x! * by[0], z! * by[2]]),
  }));
  return {
    ...file,
    trunk: {
      ...trunk,
      size: trunk.size.map((v, i) => (i === axis ? size : v)) as typeof trunk.size,
      inertia: stretched(trunk.inertia, by, 1) as typeof trunk.inertia,
      ...(outline.length > 0 ? { outline } : {}),
    },
  };
}

/** Shares of the legs' length between which the robot can stand at all. */
const [LOW, HIGH] = [0.12, 0.98];

export function heights(file: RobotDocument): { least: number; most: number } {
  const rear = file.rear;
  const reach = Math.min(
    file.thigh.length + file.calf.length,
    (rear?.thigh ?? file.thigh).length + (rear?.calf ?? file.calf).length,
  );
  return { least: file.wheel.radius + LOW * reach, most: file.wheel.radius + HIGH * reach };
}

/** The same robot, standing where its legs let it. */
export function standing(file: RobotDocument): RobotDocument {
  const { least, most } = heights(file);
  const height = Math.min(most, Math.max(least, file.nominal_height));
  return height === file.nominal_height ? file : { ...file, nominal_height: height };
}
