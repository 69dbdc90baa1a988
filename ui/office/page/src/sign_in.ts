// Name and password.
import { make } from "../report_src/dom.ts";
import { tr } from "../report_src/words.ts";
import { post, type Me } from "./api.ts";
import { form, input, type View } from "./parts.ts";

export function sign_in(done: (me: Me) => void): View {
  const name = input(tr("Name"), { autocomplete: "username", required: "" });
  const password = input(tr("Password"), { type: "password", autocomplete: "current-password", required: "" });
  const asked = form(tr("Sign in"), async () => done(await post<Me>("/api/sign-in", { name: name.value, password: password.value })), name.block, password.block);
  return { first: name, root: make("div", { class: "narrow" }, make("h1", {}, tr("Sign in at the exam office")), asked) };
}
