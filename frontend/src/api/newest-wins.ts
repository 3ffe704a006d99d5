/**
 * At most one request in flight. While it runs only the newest question is kept; when the answer
 * comes back, or the running one yields to it, that question is sent. Answers older than the one
 * already shown are dropped.
 */

interface Asked<Question> {
  question: Question;
  sequence: number;
}

interface Handlers<Question, Answer> {
  solve: (question: Question, signal: AbortSignal) => Promise<Answer>;
  show: (answer: Answer, question: Question, newest: boolean) => void;
  fail: (error: unknown, question: Question, newest: boolean) => void;
  /** Whether a running question that was sent `since` ms ago is given up for the next one. */
  yields: (running: Question, next: Question, since: number) => boolean;
}

export class NewestWins<Question, Answer> {
  private waiting: Asked<Question> | null = null;
  private current: (Asked<Question> & { abort: AbortController; sent: number }) | null = null;
  private asked = 0;
  private shown = 0;

  constructor(private readonly on: Handlers<Question, Answer>) {}

  ask(question: Question): void {
    this.waiting = { question, sequence: ++this.asked };
    const running = this.current;
    if (!running) void this.pump();
    else if (this.on.yields(running.question, question, performance.now() - running.sent)) {
      running.abort.abort();
    }
  }

  /** Forget what was asked: an answer still on its way will not be shown. */
  forget(): void {
    this.waiting = null;
    this.shown = ++this.asked;
    this.current?.abort.abort();
  }

  private async pump(): Promise<void> {
    while (this.waiting) {
      const now = { ...this.waiting, abort: new AbortController(), sent: performance.now() };
      this.waiting = null;
      this.current = now;
      try {
        const answer = await this.on.solve(now.question, now.abort.signal);
        if (now.sequence > this.shown && !now.abort.signal.aborted) {
          this.shown = now.sequence;
          this.on.show(answer, now.question, now.sequence === this.asked);
        }
      } catch (error) {
        if (!now.abort.signal.aborted) {
          this.on.fail(error, now.question, now.sequence === this.asked);
        }
      }
    }
    this.current = null;
  }
}
