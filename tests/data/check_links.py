"""Every relative link and picture of README.md and the pages under docs/ and data/ leads to a file of the source tree.

Usage: check_links.py SOURCE_DIR
"""
import pathlib
import re
import sys


def main(root):
    pages = [root / "README.md", *sorted(root.glob("docs/**/*.md")), *sorted(root.glob("data/**/*.md"))]
    count, faults = 0, []
    for page in pages:
        for target in re.findall(r"\]\(([^)#\s]+)", page.read_text(encoding="utf-8")):
            if re.match(r"[a-z]+:", target):
                continue
            count += 1
            if not (page.parent / target).exists():
                faults.append(f"{page.relative_to(root)}: {target} is not there")
    if count < 10:
        faults.append(f"found only {count} links: the pattern no longer fits")
    print("\n".join(faults) or f"{count} links")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))
