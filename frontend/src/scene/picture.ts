/** The scene as a picture: what its canvas showed in the frame that was just drawn. */

import { reasonOf } from "../api/client";
import { plan } from "../state/planning";
import { toast } from "../state/toast";
import { saveFile } from "../ui/save-file";
import { session, stirScene } from "./drive";

/** A frame is drawn by then, or the scene is not drawing [ms]. */
const PATIENCE = 8000;
/** A scene at rest draws only when something moves [ms]. */
const STIR = 200;

/** Small, to see whether anything was drawn at all [px]. */
const PROBE = 16;

/**
 * WebGL keeps a frame only until it is shown, so the copy is made right after it was drawn: for as
 * long as it takes, each frame that the scene asks for ends with a look at its canvas.
 */
function grab(frame: Window, canvas: HTMLCanvasElement): Promise<Blob> {
  const own = frame.requestAnimationFrame;
  const probe = new OffscreenCanvas(PROBE, PROBE).getContext("2d", { willReadFrequently: true })!;
  const drawn = () => {
    probe.clearRect(0, 0, PROBE, PROBE);
    probe.drawImage(canvas, 0, 0, PROBE, PROBE);
    return probe.getImageData(0, 0, PROBE, PROBE).data.some((v, i) => i % 4 === 3 && v > 0);
  };
  const stirring = setInterval(stirScene, STIR);
  return new Promise<Blob>((resolve, reject) => {
    const timer = setTimeout(() => reject(new Error("the scene draws nothing")), PATIENCE);
    frame.requestAnimationFrame = (callback) =>
      own.call(frame, (time) => {
        callback(time);
        if (!drawn()) return;
        frame.requestAnimationFrame = own;
        clearTimeout(timer);
        canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("it is empty"))));
      });
  }).finally(() => {
    clearInterval(stirring);
    frame.requestAnimationFrame = own;
  });
}

/** The frame that the scene is drawn in, and its canvas, once there is one. */
export function drawnScene(): { frame: Window; canvas: HTMLCanvasElement } | null {
  const frame = document.querySelector<HTMLIFrameElement>(".v3 iframe")?.contentWindow;
  // viser keeps further ones, of no size.
  const canvas = [...(frame?.document.querySelectorAll("canvas") ?? [])].find(
    (each) => each.width > PROBE && each.height > PROBE,
  );
  if (frame && canvas && session.peek()) return { frame, canvas };
  toast.value = { text: "The scene has not been drawn yet" };
  return null;
}

export function sceneFileName(ending: string): string {
  const shown = plan.peek();
  return `${shown?.terrain.name ?? "scene"}-${shown?.robot ?? "robot"}-scene.${ending}`;
}

export async function saveScene(): Promise<void> {
  const drawn = drawnScene();
  if (!drawn) return;
  try {
    saveFile(sceneFileName("png"), await grab(drawn.frame, drawn.canvas));
  } catch (error) {
    const why = reasonOf(error);
    toast.value = { text: `No picture was saved: ${why}` };
  }
}
