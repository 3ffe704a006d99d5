/** What a file from outside holds: a robot, or a profile. */

const OTHER_TOOLS = /\.(urdf|mjcf|xml|zip)$/i;
const DOCUMENT = /\.(json|ya?ml)$/i;
/** Documents name their kind near their beginning, and before those that they hold. */
const KIND = /schema["']?\s*:\s*["']?stairwright\/([a-z]+)\//;
const HEAD = 4096;

export async function holdsRobot(file: File): Promise<boolean> {
  if (OTHER_TOOLS.test(file.name)) return true;
  if (!DOCUMENT.test(file.name)) return false;
  return KIND.exec(await file.slice(0, HEAD).text())?.[1] === "robot";
}

/** Pasted text as a file whose ending says what it looks like. */
export function pastedFile(text: string): File {
  const trimmed = text.trim();
  return new File([trimmed], `pasted.${endingOf(trimmed)}`, { type: "text/plain" });
}

function endingOf(text: string): string {
  if (/^[{[]/.test(text)) return "json";
  if (text.startsWith("<")) return "xml";
  return /(^|\n)\s*(points|schema|kind)\s*:/.test(text) ? "yaml" : "csv";
}
