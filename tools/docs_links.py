"""Hook of MkDocs: what a page links to outside docs/ is no page of the site, so its path is shown instead."""

import posixpath
import re

LINK = re.compile(r"(?<!!)\[([^\]]+)\]\(([^)#\s]+)(#[^)\s]*)?\)")


def on_page_markdown(markdown, page, **_):
    folder = posixpath.dirname(page.file.src_uri)

    def shown(link):
        text, target, _ = link.groups()
        path = posixpath.normpath(posixpath.join("docs", folder, target))
        if "://" in target or path.startswith("docs/"):
            return link[0]
        return text if text.strip("`") == path else f"{text} (`{path}`)"

    return LINK.sub(shown, markdown)
