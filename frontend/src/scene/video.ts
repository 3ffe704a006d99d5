/** The replay as a video: what the scene's canvas shows from the start to the end, in real time. */

import { effect, signal } from "@preact/signals";
import { duration, playing, seek } from "../state/playback";
import { toast } from "../state/toast";
import { saveFile } from "../ui/save-file";
import { drawnScene, sceneFileName } from "./picture";

/** WebM where the browser writes it, else MP4. */
const TYPES = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];

/** Most frames a second. */
const RATE = 30;
/** The scene shows the last pose a little after the clock [ms]. */
const LAST_POSE = 400;
/** Pieces of the video come this often [ms]. */
const PIECE = 500;

export const recording = signal(false);
let recorder: MediaRecorder | null = null;

const offered = () => TYPES.find((type) => globalThis.MediaRecorder?.isTypeSupported(type));

/** Stop before the end: what was recorded is saved. */
export function stopVideo(): void {
  playing.value = false;
}

/** Play from the start and save what the scene shows; ends with the replay, or with `stopVideo`. */
export function recordVideo(): void {
  const drawn = drawnScene();
  if (!drawn || recording.peek() || duration.peek() <= 0) return;
  const mimeType = offered();
  if (!mimeType) {
    toast.value = { text: "This browser cannot record video" };
    return;
  }
  const stream = drawn.canvas.captureStream(RATE);
  const pieces: Blob[] = [];
  recorder = new MediaRecorder(stream, { mimeType, videoBitsPerSecond: 6e6 });
  recorder.ondataavailable = ({ data }) => {
    if (data.size > 0) pieces.push(data);
  };
  recorder.onerror = () => {
    toast.value = { text: "No video was saved: the recording failed" };
    pieces.length = 0;
    playing.value = false;
  };
  recorder.onstop = () => {
    for (const track of stream.getTracks()) track.stop();
    recorder = null;
    recording.value = false;
    if (pieces.length === 0) return;
    const type = mimeType.split(";")[0]!;
    saveFile(sceneFileName(type.endsWith("mp4") ? "mp4" : "webm"), new Blob(pieces, { type }));
  };
  seek(0);
  recorder.start(PIECE);
  recording.value = true;
  playing.value = true;
  const done = effect(() => {
    if (playing.value) return;
    setTimeout(() => {
      done();
      if (recorder?.state === "recording") recorder.stop();
    }, LAST_POSE);
  });
}
