/**
 * The scene leaves the page the thread that both run on. Without a graphics card a frame of the
 * scene takes as long as six of the page, and a hand would feel each of them.
 */

/** What the page can give without being late itself [ms]. */
const QUICK = 1000 / 30;

/** While the hand `moves`, what the frame asks to be drawn waits, unless its last one was quick. */
export function leaveTime(frame: Window, moves: () => boolean): void {
  const own = frame.requestAnimationFrame.bind(frame);
  const drop = frame.cancelAnimationFrame.bind(frame);
  /** When the frame that is being drawn began; null between frames. */
  let begun: number | null = null;
  /** What the last frame took [ms]. */
  let cost = 0;
  // A message comes after the frame has been handed on to be shown, which is most of the work.
  const { port1: after, port2: tell } = new MessageChannel();
  after.onmessage = () => {
    cost = performance.now() - begun!;
    begun = null;
  };
  /** Requests that wait: the id that was given out, and the one that stands for it now. */
  const waiting = new Map<number, number>();
  frame.requestAnimationFrame = (callback) => {
    const id = own(function draw(time) {
      if (cost > QUICK && moves()) {
        waiting.set(id, own(draw));
        return;
      }
      waiting.delete(id);
      if (begun === null) {
        begun = performance.now();
        tell.postMessage(null);
      }
      callback(time);
    });
    return id;
  };
  frame.cancelAnimationFrame = (id) => {
    drop(waiting.get(id) ?? id);
    waiting.delete(id);
  };
}
