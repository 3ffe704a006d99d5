/**
 * At most one request in flight. While it runs only the newest question is kept; when the answer
 * comes back that question is sent. Answers older than the one already shown are dropped.
 */

interface Asked<Question> {
  question: Question;
  sequence: number;
}

export class NewestWins<Question, Answer> {
  private waiting: Asked<Question> | null = null;
  private current: (Asked<Question> & { abort: AbortController }) | null = null;
  private asked = 0;
  private shown = 0;

  constructor(
    private readonly solve: (question: Question, signal: AbortSignal) => Promise<Answer>,
    private readonly show: (answer: Answer, question: Question, newest: boolean) => void,
    private readonly fail: (error: unknown, question: Question, newest: boolean) => void,
  ) {}

  ask(question: Question): void {
    this.waiting = { question, sequence: ++this.asked };
    if (!this.current) void this.pump();
  }

  /** Forget what was asked: an answer still on its way will not be shown. */
  forget(): void {
    this.waiting = null;
    this.shown = ++this.asked;
    this.current?.abort.abort();
  }

  private async pump(): Promise<void> {
    while (this.waiting) {
      const now = { ...this.waiting, abort: new AbortController() };
      this.waiting = null;
      this.current = now;
      try {
        const answer = await this.solve(now.question, now.abort.signal);
        if (now.sequence > this.shown) {
          this.shown = now.sequence;
          this.show(answer, now.question, now.sequence === this.asked);
        }
      } catch (error) {
        if (!now.abort.signal.aborted) {
          this.fail(error, now.question, now.sequence === this.asked);
        }
      }
    }
    this.current = null;
  }
}
