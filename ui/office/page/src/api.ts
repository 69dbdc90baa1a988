// Requests to the server that the page came from. Whatever changes something bears the sign-in's token.
import type { Nothing, Route } from "../made/routes.ts";
import { tr } from "../report_src/words.ts";

/** Whether who is signed in may use a route. */
export type May = (route: Route<unknown, unknown>) => boolean;

/** What the server refused, in words. */
export class Refused extends Error {
  constructor(
    readonly status: number,
    text: string,
  ) {
    super(text);
  }
}

let token = "";
export function set_token(text: string): void {
  token = text;
}

async function ask({ method, path }: Route<unknown, unknown>, body?: unknown): Promise<Response> {
  const headers: { [name: string]: string } = {};
  if (body !== undefined) headers["Content-Type"] = "application/json";
  if (method !== "GET") headers["X-Cavum-Token"] = token;
  let response: Response;
  try {
    response = await fetch(path, {
      method,
      headers,
      body: body === undefined ? undefined : JSON.stringify(body),
      credentials: "same-origin",
    });
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

export async function get<Answer>(route: Route<Nothing, Answer>): Promise<Answer> {
  return (await ask(route)).json() as Promise<Answer>;
}
/** A file, given to the browser to keep; what the office says instead is thrown. */
export async function download(route: Route<Nothing, unknown>, name: string): Promise<void> {
  const href = URL.createObjectURL(await (await ask(route)).blob());
  Object.assign(document.createElement("a"), { href, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(href), 60_000);
}
export async function post<Request, Answer>(
  route: Route<Request, Answer>,
  body: NoInfer<Request>,
): Promise<Answer> {
  return (await ask(route, body)).json() as Promise<Answer>;
}
/** Each event, until the source is closed. */
export function listen<Event>(
  route: Route<Nothing, Event>,
  take: (event: Event) => void,
): EventSource {
  const source = new EventSource(route.path);
  source.onmessage = (event: MessageEvent<string>) => take(JSON.parse(event.data) as Event);
  return source;
}
