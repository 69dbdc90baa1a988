// Learning platforms (LTI 1.3): what goes to each gradebook, what the platform's administrator types in there, set-up.
import { routes, type LtiSetUp, type PlatformShown, type ScoresOfCourse } from "../made/routes.ts";
import { make } from "../report_src/dom.ts";
import { tr } from "../report_src/words.ts";
import { get, post } from "./api.ts";
import {
  act,
  code_field,
  field,
  form,
  input,
  local_time,
  say,
  select,
  table,
  type View,
} from "./parts.ts";

export async function platforms(second_factor: boolean): Promise<View> {
  const root = make("div");
  const show = (now: LtiSetUp): void => {
    root.replaceChildren(
      make("h1", {}, tr("Learning platforms")),
      scores(now.progress, async () => show(await get(routes.lti))),
      ...now.platforms.map(card),
      ...(second_factor
        ? changes(now, show)
        : [
            make(
              "p",
              { class: "wrong" },
              tr("This account has no second factor, and changes nothing here."),
            ),
          ]),
    );
  };
  show(await get(routes.lti));
  return { root };
}

function scores(courses: ScoresOfCourse[], look: () => Promise<void>): HTMLElement {
  const section = make("section", {}, make("h2", {}, tr("Scores")));
  if (courses.length === 0)
    section.append(
      make(
        "p",
        {},
        tr(
          "No course is known yet. One is known as soon as somebody opens its link on the platform.",
        ),
      ),
    );
  else {
    const rows = courses.map((c) => [
      c.title || c.exam,
      c.platform,
      c.exam,
      String(c.sent),
      String(c.waiting),
      String(c.unknown),
      String(c.refused),
      c.trouble,
    ]);
    section.append(
      table(
        tr("Courses: {}", courses.length),
        [
          tr("Course"),
          tr("Platform"),
          tr("Exam"),
          tr("Sent"),
          tr("Waiting"),
          tr("Has not opened the link yet"),
          tr("Refused"),
          tr("What keeps them back"),
        ],
        rows,
      ),
    );
  }
  section.append(
    make(
      "div",
      { class: "row" },
      act(tr("Look again"), {}, look),
      act(tr("Send again now"), {}, async () => {
        await post(routes.send_scores, {});
        say(tr("What waits or was refused is sent again. Look again in a moment."));
      }),
    ),
  );
  return section;
}

function card(p: PlatformShown): HTMLElement {
  const list = make("dl");
  const put = (what: string, value: string): void =>
    list.append(make("dt", {}, what), make("dd", {}, make("code", {}, value)));
  put(tr("Tool URL"), p.addresses.tool);
  put(tr("Initiate login URL"), p.addresses.login);
  put(tr("Redirection URI"), p.addresses.redirect);
  put(tr("Public keyset URL"), p.addresses.keys);
  const known = make(
    "p",
    {},
    tr(
      "Issuer {0}, client {1}, deployments {2}; candidates are matched by {3}.",
      p.issuer,
      p.client_id,
      p.deployments.join(", "),
      p.claim,
    ),
  );
  const people = Object.entries(p.accounts).map(([sub, account]) =>
    make("li", {}, tr("{0} is the account of {1}", sub, account)),
  );
  return make(
    "section",
    { class: "card" },
    make("h2", {}, p.name),
    make("p", {}, tr("Its administrator types in there:")),
    list,
    known,
    make("ul", {}, ...people),
  );
}

function changes(now: LtiSetUp, show: (now: LtiSetUp) => void): HTMLElement[] {
  const line = (label: string, hint = "", needed = true): ReturnType<typeof input> =>
    input(
      label,
      { autocomplete: "off", maxlength: "1000", ...(needed ? { required: "" } : {}) },
      hint,
    );
  const name = line(tr("Name of the platform")),
    issuer = line(tr("Issuer"), tr("Moodle calls it Platform ID.")),
    client = line(tr("Client ID"));
  const deployments = line(tr("Deployment IDs"), tr("Several with commas between them."));
  const auth = line(tr("Authentication request URL")),
    token = line(tr("Access token URL")),
    keys = line(
      tr("Public keyset URL of the platform"),
      tr("Or the key set itself, below."),
      false,
    );
  const key_set = field(
    tr("Key set"),
    make("textarea", { spellcheck: "false" }),
    tr("Only where the platform shows none at an address."),
  ) as HTMLTextAreaElement & { block: HTMLElement };
  const claim = line(
    tr("Candidates are matched by"),
    tr("sub, custom.NAME or lis.NAME: its value is the number in the class list. Never a name."),
  );
  claim.value = "custom.number";
  const audience = line(
    tr("Audience of our tokens"),
    tr("Empty: the access token URL itself."),
    false,
  );
  const hosts = line(
    tr("Further addresses of its services"),
    tr(
      "Canvas: the school's own address, such as https://school.instructure.com. Several with commas.",
    ),
    false,
  );
  const certificate = field(
    tr("Certificate (PEM)"),
    make("textarea", { spellcheck: "false" }),
    tr("Only where the platform's certificate is none that this computer trusts."),
  ) as HTMLTextAreaElement & { block: HTMLElement };
  const code = code_field();
  const set = form(
    tr("Set it up"),
    async () => {
      const platform = {
        name: name.value,
        office: location.origin,
        issuer: issuer.value,
        client_id: client.value,
        deployments: listed(deployments.value),
        auth_endpoint: auth.value,
        token_endpoint: token.value,
        jwks_url: keys.value,
        key_set: key_set.value,
        claim: claim.value,
        token_audience: audience.value,
        certificate: certificate.value,
        hosts: listed(hosts.value),
      };
      show(await post(routes.set_platform, { platform, code: code.value }));
      say(tr("Set up. Give the platform's administrator the addresses above."));
    },
    name.block,
    issuer.block,
    client.block,
    deployments.block,
    auth.block,
    token.block,
    keys.block,
    key_set.block,
    claim.block,
    audience.block,
    hosts.block,
    certificate.block,
    code.block,
  );
  const out: HTMLElement[] = [
    make("details", {}, make("summary", {}, tr("Set up a platform, or change one")), set),
  ];
  if (now.platforms.length > 0) out.push(link(now, show), remove(now, show));
  out.push(new_key(now, show));
  return out;
}

function listed(text: string): string[] {
  return text
    .split(",")
    .map((one) => one.trim())
    .filter((one) => one !== "");
}

function which(now: LtiSetUp): ReturnType<typeof select> {
  return select(
    tr("Platform"),
    now.platforms.map((p, i): [string, string] => [String(i), `${p.name}, ${p.client_id}`]),
  );
}

function link(now: LtiSetUp, show: (now: LtiSetUp) => void): HTMLElement {
  const platform = which(now),
    sub = input(tr("The person's number there (sub)"), { required: "", autocomplete: "off" });
  const account = input(
    tr("Account at this office"),
    { autocomplete: "off" },
    tr(
      "Empty: nobody's any more. Whoever rules the platform can then act as this account, but for its codes.",
    ),
  );
  const code = code_field();
  return make(
    "details",
    {},
    make("summary", {}, tr("An instructor who has an account here")),
    form(
      tr("Link them"),
      async () => {
        const { issuer, client_id } = now.platforms[Number(platform.value)]!;
        show(
          await post(routes.link_person, {
            issuer,
            client_id,
            sub: sub.value,
            account: account.value,
            code: code.value,
          }),
        );
        say(tr("Done."));
      },
      platform.block,
      sub.block,
      account.block,
      code.block,
    ),
  );
}

function remove(now: LtiSetUp, show: (now: LtiSetUp) => void): HTMLElement {
  const platform = which(now),
    code = code_field();
  return make(
    "details",
    {},
    make("summary", {}, tr("Remove a platform")),
    form(
      tr("Remove it"),
      async () => {
        const { issuer, client_id } = now.platforms[Number(platform.value)]!;
        show(await post(routes.remove_platform, { issuer, client_id, code: code.value }));
        say(tr("Removed. Who came from there is signed out."));
      },
      platform.block,
      code.block,
    ),
  );
}

function new_key(now: LtiSetUp, show: (now: LtiSetUp) => void): HTMLElement {
  const code = code_field();
  return make(
    "details",
    {},
    make("summary", {}, tr("This office's key for platforms")),
    make(
      "ul",
      {},
      ...now.keys.map((k) =>
        make("li", {}, make("code", {}, k.kid), " ", tr("made {}", local_time(k.made))),
      ),
    ),
    form(
      tr("Make a new key"),
      async () => {
        show(await post(routes.new_key, { code: code.value }));
        say(tr("Made. The one before stays known until the next."));
      },
      code.block,
    ),
  );
}
