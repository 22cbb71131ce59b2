// The secret of the link: taken out of the address at once, kept for this tab and this port, and
// sent to the program with every request.

const KEPT_AS = "hapticgiant.token";
const NAME = "token";

// What behind # is an option of the page; the token is taken out of it.
export function page_options(): URLSearchParams {
  return new URLSearchParams(location.hash.slice(1));
}

// True when there was one in the address.
function keep_token(): boolean {
  const options = page_options();
  const token = options.get(NAME);
  if (token === null) return false;
  sessionStorage.setItem(KEPT_AS, token);
  options.delete(NAME);
  const rest = options.toString();
  history.replaceState(null, "", location.pathname + location.search + (rest && `#${rest}`));
  return true;
}

// Also a link that is opened in a tab that shows the page already: of a program that was started again.
export function watch_token(): void {
  keep_token();
  addEventListener("hashchange", () => {
    if (keep_token()) location.reload();
  });
}

export function token(): string {
  return sessionStorage.getItem(KEPT_AS) ?? "";
}

// Of requests.
export function authorization(): Record<string, string> {
  return { Authorization: `Bearer ${token()}` };
}

// Of the WebSocket, which cannot have headers: the program takes the first.
export function protocols(name = "hapticgiant"): string[] {
  return [name, `token.${token()}`];
}
