// Requests to the server that the page came from. Whatever changes something bears the sign-in's token.
import { tr } from "../report_src/words.ts";

export interface Me {
  name: string;
  role: string;
  token: string;
  /** Doors that the role may use: "POST /api/release". */
  may: string[];
  school: string;
  second_factor: boolean;
  rehearsal: boolean;
}

/** What the server refused, in words. */
export class Refused extends Error {
  constructor(readonly status: number, text: string) {
    super(text);
  }
}

let token = "";
export function set_token(text: string): void {
  token = text;
}

async function ask(method: string, path: string, body?: unknown): Promise<Response> {
  const headers: { [name: string]: string } = {};
  if (body !== undefined) headers["Content-Type"] = "application/json";
  if (method !== "GET") headers["X-Cavum-Token"] = token;
  let response: Response;
  try {
    response = await fetch(path, { method, headers, body: body === undefined ? undefined : JSON.stringify(body), credentials: "same-origin" });
  } catch {
    throw new Refused(0, tr("The office does not answer. Look at the network, and try again."));
  }
  if (response.ok) return response;
  let text = tr("This did not work ({}).", response.status);
  try {
    text = ((await response.json()) as { error: string }).error;
  } catch {
    // no words of the office's
  }
  throw new Refused(response.status, text);
}

export async function get<T>(path: string): Promise<T> {
  return (await ask("GET", path)).json() as Promise<T>;
}
/** A file, given to the browser to keep; what the office says instead is thrown. */
export async function download(path: string, name: string): Promise<void> {
  const href = URL.createObjectURL(await (await ask("GET", path)).blob());
  Object.assign(document.createElement("a"), { href, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(href), 60_000);
}
export async function post<T>(path: string, body: unknown): Promise<T> {
  return (await ask("POST", path, body)).json() as Promise<T>;
}
