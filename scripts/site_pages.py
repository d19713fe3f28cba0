"""A hook of mkdocs: takes the documents of the tree's root into the site, where docs/README.md is the page of the method."""

import pathlib
import re

from mkdocs.structure.files import File

ROOT = pathlib.Path(__file__).resolve().parents[1]
# By name in the site: the document of the root.
PAGES = {"start.md": "README.md", "format.md": "FORMAT.md", "contributing.md": "CONTRIBUTING.md",
         "security.md": "SECURITY.md", "decisions.md": "DECISIONS.md", "changes.md": "CHANGELOG.md", "LICENSE": "LICENSE"}
PLACES = {name: place for place, name in PAGES.items()}


def on_files(files, config):
    """Adds the documents of the root; README.md of the root is the first page of the site."""
    method = files.get_file_from_path("README.md")
    method.dest_path, method.url = "method.html", "method.html"
    method.abs_dest_path = str(pathlib.Path(config["site_dir"]) / method.dest_path)
    for place, name in PAGES.items():
        file = File(place, config["docs_dir"], config["site_dir"], config["use_directory_urls"])
        file.abs_src_path = str(ROOT / name)
        if place == "start.md":
            file.dest_path, file.url = "index.html", "index.html"
            file.abs_dest_path = str(pathlib.Path(config["site_dir"]) / file.dest_path)
        files.append(file)
    return files


def on_page_markdown(markdown, page, **_):
    """Links between the root and docs/ become links between pages of the site."""
    def linked(match):
        target = match[1]
        up = "../" * page.file.src_path.count("/")  # from the page's folder to docs/
        if page.file.src_path in PAGES:
            target = target.removeprefix("docs/") if target.startswith("docs/") else PLACES.get(target, target)
        elif target.startswith(f"{up}../"):
            place = PLACES.get(target.removeprefix(f"{up}../"))
            target = f"{up}{place}" if place else target
        return f"]({target}{match[2]}"

    return re.sub(r"\]\(([^)#:]+)([)#])", linked, markdown)
