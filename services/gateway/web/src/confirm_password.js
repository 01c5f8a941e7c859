// @ts-check
// What takes something away asks why, and for the password once more.
import { get, post } from "./api.js";
import { el } from "./dom.js";
import { askForm } from "./form_dialog.js";
import { choice, labelled, passwordInput } from "./form_fields.js";
import { rememberPlace } from "./identity.js";

/**
 * Ask for the password, and a reason where one is wanted; then do it.
 * @param {object} wish
 * @param {string} wish.title
 * @param {string} wish.about what will happen
 * @param {string} wish.action word on the button
 * @param {[string, string][]} [wish.reasons] value and words of the reasons to choose from, where one is asked for
 * @param {Node[]} [wish.fields] what else is asked, before the reason
 * @param {(reason: string) => Promise<unknown>} wish.act told the value of the reason, empty where none was asked for
 * @returns {Promise<boolean>} whether it was done
 */
export async function confirmPassword({ title, about, action, reasons = [], fields = [], act }) {
  const { provider } = await get("/me");
  const why = choice([["", "Choose one"], ...reasons]);
  why.required = true;
  const password = passwordInput("current-password");
  const asked = [...fields];
  if (reasons.length > 0) asked.push(labelled("Reason", why, "Kept in the audit for good."));
  asked.push(provider ? elsewhere(provider) : labelled("Your password", password));
  return askForm({
    title,
    about,
    fields: asked,
    action,
    danger: true,
    act: async () => {
      if (!provider) await post("/sign-in/confirmation", { body: { password: password.value } });
      await act(why.value);
    },
  });
}

/** Who signs in with the organisation's service confirms there. @param {string} provider */
function elsewhere(provider) {
  const href = `/v1/sign-in/oidc/${encodeURIComponent(provider)}?again=true`;
  return el("p", {}, "First ", el("a", { href, onclick: rememberPlace }, `sign in with ${provider} again`), ", then do this within five minutes.");
}
