// Name and password.
import { routes, type Me } from "../made/routes.ts";
import { make } from "../report_src/dom.ts";
import { tr } from "../report_src/words.ts";
import { post } from "./api.ts";
import { act, form, input, type View } from "./parts.ts";

/** `by_proxy`: the school's own accounts are good here, too. */
export function sign_in(done: (me: Me) => void, by_proxy: boolean): View {
  const name = input(tr("Name"), { autocomplete: "username", required: "" });
  const password = input(tr("Password"), {
    type: "password",
    autocomplete: "current-password",
    required: "",
  });
  const asked = form(
    tr("Sign in"),
    async () => done(await post(routes.sign_in, { name: name.value, password: password.value })),
    name.block,
    password.block,
  );
  const root = make("div", { class: "narrow" }, make("h1", {}, tr("Sign in at the exam office")));
  if (!by_proxy) {
    root.append(asked);
    return { first: name, root };
  }
  const first = act(tr("Sign in with the school's account"), { class: "main" }, async () =>
    done(await post(routes.sign_in_by_proxy, {})),
  );
  root.append(first, make("h2", {}, tr("Or with a password of the office")), asked);
  return { first, root };
}
