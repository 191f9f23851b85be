"""Opens the pages of a report in a headless Chromium and says what a reader would see go wrong.

    python3 tests/browser.py report                 # exit code 1 and a line per defect
    python3 tests/browser.py report --shots DIR     # and whole pages as pictures
    python3 tests/browser.py report --pages index.html race.html

Every page at 1400 and 400 px, light and dark: nothing scrolls sideways, no text is cut, covered or too pale, every link leads
somewhere, switches answer to the keyboard, and paper shows all that a switch hides. Each check is first seen to fail, by a fault
planted in the front page. Needs `chromium` (or what CHROMIUM names) and Python, no package.
"""
import argparse
import base64
import glob
import html
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from urllib.parse import unquote

NAMES = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"]
SCREENS = [(1400, 900), (400, 800)]

# What is wrong on the page that is open, as sentences.
LOOK = r"""(() => {
  const wrong = [];
  const words = (element) => (element.textContent || "").trim().replace(/\s+/g, " ").slice(0, 60);
  const wide = document.documentElement.clientWidth;
  if (document.documentElement.scrollWidth > wide + 1) {
    const out = [...document.querySelectorAll("main *, header *")].find((one) => one.getBoundingClientRect().right > wide + 1 && !one.closest(".table, pre"));
    wrong.push(`sideways: the page is ${document.documentElement.scrollWidth} px wide on ${wide}: ${out ? out.tagName + " " + words(out) : ""}`);
  }
  const shown = (element) => element.getClientRects().length > 0 && getComputedStyle(element).visibility !== "hidden";
  if (wide > 1000) for (const box of document.querySelectorAll(".table")) {
    if (shown(box) && box.scrollWidth > box.clientWidth + 1) wrong.push(`sideways: a table is ${box.scrollWidth} px wide on ${box.clientWidth}: ${words(box)}`);
  }
  const number = (text) => (text.match(/[\d.]+/g) || []).map(Number);
  const light = (rgb) => { const part = rgb.slice(0, 3).map((c) => c / 255).map((c) => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
    return 0.2126 * part[0] + 0.7152 * part[1] + 0.0722 * part[2]; };
  const contrast = (a, b) => { const [x, y] = [light(a), light(b)]; return (Math.max(x, y) + 0.05) / (Math.min(x, y) + 0.05); };
  const ground = (element) => {
    for (let one = element; one; one = one.parentElement) {
      if (one instanceof SVGSVGElement) { const rect = one.querySelector("rect"); if (rect && rect.getBBox().width >= 0.9 * one.viewBox.baseVal.width) return number(getComputedStyle(rect).fill); }
      const colour = number(getComputedStyle(one).backgroundColor);
      if (colour.length === 3 || colour[3] > 0.5) return colour;
    }
    return [255, 255, 255];
  };
  const pale = new Map();
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const node = walker.currentNode, element = node.parentElement;
    if (!node.data.trim() || !element || ["SCRIPT", "STYLE", "TITLE", "title", "desc"].includes(element.tagName) || !shown(element) || element.closest("input, .skip")) continue;
    const range = document.createRange(); range.selectNodeContents(node);
    const at = range.getBoundingClientRect();
    if (at.width === 0 || at.right < 0) continue;
    const style = getComputedStyle(element), svg = element.closest("svg");
    const back = ground(element);
    const colour = number(svg ? style.fill : style.color);
    const large = parseFloat(style.fontSize) * (svg ? svg.getBoundingClientRect().width / svg.viewBox.baseVal.width : 1) >= 24;
    const found = contrast(colour, back);
    if (style.opacity !== "0" && found < (large ? 3 : 4.5) - 0.01 && !element.closest(".anchor")) pale.set(`${colour} on ${back}`, `pale: ${found.toFixed(2)} ${colour} on ${back}: ${words(element)}`);
    if (svg) { const box = svg.getBoundingClientRect();
      if (at.left < box.left - 1 || at.right > box.right + 1 || at.top < box.top - 1 || at.bottom > box.bottom + 1) wrong.push(`cut: ${words(element)} leaves its figure`);
      const size = parseFloat(style.fontSize) * box.width / svg.viewBox.baseVal.width;
      if (size < 6.5) wrong.push(`cut: letters of ${size.toFixed(1)} px: ${words(element)}`);
    } else {
      const scroll = element.closest(".table, pre");
      if (!scroll && (at.right > wide + 1 || at.left < -1)) wrong.push(`cut: ${words(element)} ends at ${at.right.toFixed(0)} of ${wide}`);
      for (let one = element; one && one !== document.body; one = one.parentElement) {
        const over = getComputedStyle(one).overflowX;
        if (over === "visible" || one.matches(".table, pre")) continue;
        if (one.scrollWidth > one.clientWidth + 1) { wrong.push(`cut: ${words(one)} in a box of ${one.clientWidth} px`); break; }
      }
    }
  }
  wrong.push(...pale.values());
  for (const svg of document.querySelectorAll("figure svg")) {
    if (svg.parentElement.closest("svg") || !shown(svg)) continue;
    const texts = [...svg.querySelectorAll("text")].filter(shown).map((one) => [one.getBoundingClientRect(), words(one)]);
    for (let i = 0; i < texts.length; i++) for (let j = 0; j < i; j++) {
      const [a, b] = [texts[i][0], texts[j][0]];
      const x = Math.min(a.right, b.right) - Math.max(a.left, b.left), y = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      if (x > 3 && y > 0.45 * Math.min(a.height, b.height)) wrong.push(`covered: "${texts[j][1]}" and "${texts[i][1]}" lie upon each other in ${svg.getAttribute("aria-label").slice(0, 50)}`);
    }
  }
  return [...new Set(wrong)];
})()"""

# On paper: all views of a switch, each with its word, and no row of buttons.
PAPER = r"""(() => {
  const wrong = [];
  for (const box of document.querySelectorAll(".switch")) {
    const views = box.querySelectorAll(":scope > div"), labels = box.querySelectorAll(":scope > div > .view");
    for (const view of views) if (!view.getClientRects().length) wrong.push("paper: a view is hidden");
    for (const label of labels) if (!label.getClientRects().length) wrong.push(`paper: the word "${label.textContent}" is hidden`);
    if (views.length !== labels.length) wrong.push("paper: a view has no word");
  }
  return [...new Set(wrong)];
})()"""

# Faults that the checks must see: what each begins its sentence with, and the change to the page.
FAULTS = [
    ("sideways", "document.querySelector('h1').style.width = '3000px'"),
    ("cut", "Object.assign(document.querySelector('h1').style, {width: '40px', overflow: 'hidden', whiteSpace: 'nowrap'})"),
    ("cut", "document.querySelector('figure text').setAttribute('x', '-900')"),
    ("pale", "document.querySelector('figcaption').style.color = '#b8b8b8'"),
    ("pale", "document.querySelector('figure text').style.fill = '#e0e0e0'"),
    ("covered", "(() => { const [a, b] = document.querySelectorAll('figure text'); for (const k of ['x', 'y', 'text-anchor']) b.setAttribute(k, a.getAttribute(k)); })()"),
    ("link", "document.querySelector('main a').setAttribute('href', 'nowhere.html')"),
    ("link", "document.querySelector('main a').setAttribute('href', '#nowhere')"),
    ("keyboard", "document.querySelectorAll('.switch > input').forEach((one) => { one.disabled = true; })"),
    ("paper", "document.head.insertAdjacentHTML('beforeend', '<style>.view { display: none !important; }</style>')"),
]


class Browser:
    """A Chromium that is spoken to through a pipe."""

    def __init__(self, program):
        self.profile = tempfile.mkdtemp()
        there, self.write = os.pipe()
        self.read, back = os.pipe()
        command = [program, "--headless=new", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe", "--hide-scrollbars",
                   f"--user-data-dir={self.profile}", "--allow-file-access-from-files", "about:blank"]

        def pipes():
            keep = [os.dup(there), os.dup(back)]
            os.dup2(keep[0], 3)
            os.dup2(keep[1], 4)

        # Above 4, so that nothing is closed that the program reads.
        self.process = subprocess.Popen(command, preexec_fn=pipes, close_fds=False, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        os.close(there)
        os.close(back)
        self.rest, self.number, self.events, self.session = b"", 0, [], None
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        self.ask("Page.enable")

    def message(self):
        while b"\0" not in self.rest:
            more = os.read(self.read, 1 << 20)
            if not more:
                raise SystemExit("the browser has ended")
            self.rest += more
        one, self.rest = self.rest.split(b"\0", 1)
        return json.loads(one)

    def ask(self, method, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.write, json.dumps(message).encode() + b"\0")
        while True:
            answer = self.message()
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise SystemExit(f"{method}: {answer['error']}")
                return answer["result"]
            self.events.append(answer.get("method"))

    def run(self, script):
        found = self.ask("Runtime.evaluate", expression=script, returnByValue=True)
        if "exceptionDetails" in found:
            raise SystemExit(f"a script of this test fails: {found['exceptionDetails']}")
        return found["result"].get("value")

    def open(self, path, width, height, scheme, media="screen"):
        self.ask("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600)
        self.ask("Emulation.setEmulatedMedia", media=media, features=[{"name": "prefers-color-scheme", "value": scheme}])
        self.events.clear()
        self.ask("Page.navigate", url=Path(path).resolve().as_uri())
        while "Page.loadEventFired" not in self.events:
            self.events.append(self.message().get("method"))

    def press(self, key, code):
        for kind in ("rawKeyDown", "keyUp"):
            self.ask("Input.dispatchKeyEvent", type=kind, key=key, code=key, windowsVirtualKeyCode=code)

    def picture(self, file):
        size = self.ask("Page.getLayoutMetrics")["cssContentSize"]
        clip = {"x": 0, "y": 0, "width": size["width"], "height": min(size["height"], 12000), "scale": 1}
        data = self.ask("Page.captureScreenshot", clip=clip, captureBeyondViewport=True)["data"]
        Path(file).write_bytes(base64.b64decode(data))

    def close(self):
        self.process.terminate()
        self.process.wait()
        shutil.rmtree(self.profile, ignore_errors=True)


def keyboard(browser):
    """Whether the keys of arrows pass through the views of every switch, and Tab goes from the top down."""
    wrong = []
    for place in range(browser.run("document.querySelectorAll('.switch').length")):
        box = f"document.querySelectorAll('.switch')[{place}]"
        if not browser.run(f"{box}.getClientRects().length > 0"):
            continue
        views = browser.run(f"{box}.querySelectorAll(':scope > div').length")
        browser.run(f"{box}.querySelector(':scope > input').focus()")
        for view in range(1, views):
            browser.press("ArrowRight", 39)
            if not browser.run(f"{box}.querySelectorAll(':scope > div')[{view}].getClientRects().length > 0"):
                wrong.append(f"keyboard: view {view + 1} of a switch is not reached")
        browser.press("ArrowRight", 39)
    browser.run("document.activeElement.blur(); window.scrollTo(0, 0)")
    last = -1
    for _ in range(6):
        browser.press("Tab", 9)
        place = browser.run("[...document.querySelectorAll('*')].indexOf(document.activeElement)")
        if place <= last:
            wrong.append("keyboard: Tab does not follow the page")
        last = place
    return wrong


def dead_links(folder, page, links):
    """Links that lead to no file or no place in it."""
    wrong = []
    for link in sorted(set(links)):
        if re.match(r"(https?|mailto|data):", link):
            continue
        target, _, anchor = link.partition("#")
        file = (folder / page).parent / unquote(target) if target else folder / page
        if not file.is_file():
            wrong.append(f"link: {link} is not there")
        elif anchor and file.suffix == ".html" and not re.search(rf'id="{re.escape(anchor)}"', html.unescape(file.read_text(encoding="utf-8"))):
            wrong.append(f"link: {link} has no such place")
        elif anchor and file.suffix == ".md" and f'id="{anchor}"' not in file.read_text(encoding="utf-8"):
            wrong.append(f"link: {link} has no such place")
    return wrong


LINKS = "[...document.querySelectorAll('a[href]')].map((one) => one.getAttribute('href'))"


def complaints(browser, folder, page, fault=None, shots=None):
    """What is wrong with a page on every screen; a fault is planted each time it is opened."""
    wrong = []
    for width, height in SCREENS:
        for scheme in ("light", "dark"):
            browser.open(folder / page, width, height, scheme)
            browser.run(fault or "0")
            wrong += [f"{width} {scheme}: {one}" for one in browser.run(LOOK)]
            if (width, scheme) == (1400, "light"):
                wrong += dead_links(folder, page, browser.run(LINKS))
            if shots:
                browser.picture(Path(shots) / f"{page.replace('/', '-')[:-5]}-{width}-{scheme}.png")
            if scheme == "light":
                # Views that are hidden at first.
                for view in range(1, browser.run("Math.max(0, ...[...document.querySelectorAll('.switch')].map((one) => one.querySelectorAll(':scope > input').length))") or 0):
                    browser.run(f"document.querySelectorAll('.switch').forEach((one) => one.querySelectorAll(':scope > input')[{view}]?.click())")
                    wrong += [f"{width} {scheme}, view {view + 1}: {one}" for one in browser.run(LOOK)]
    browser.open(folder / page, *SCREENS[0], "light")
    browser.run(fault or "0")
    wrong += keyboard(browser)
    browser.open(folder / page, *SCREENS[0], "light", media="print")
    browser.run(fault or "0")
    return wrong + browser.run(PAPER)


def markdown_links(folder):
    """Dead links in the Markdown of a folder."""
    wrong = []
    for file in sorted(folder.rglob("*.md")):
        text = re.sub(r"```.*?```|`[^`\n]*`", "", file.read_text(encoding="utf-8"), flags=re.S)
        links = re.findall(r"\]\(([^)\s]+)\)", text)
        wrong += [f"{file.relative_to(folder)}: {one}" for one in dead_links(folder, str(file.relative_to(folder)), links)]
    return wrong


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("folder", type=Path)
    arguments.add_argument("--pages", nargs="*")
    arguments.add_argument("--shots", type=Path)
    arguments.add_argument("--no-faults", action="store_true", help="leave out the faults that the checks must see")
    given = arguments.parse_args()
    program = os.environ.get("CHROMIUM") or next(filter(None, map(shutil.which, NAMES)), None)
    if program is None:
        print("skipped: there is no Chromium")
        return 0
    if given.shots:
        given.shots.mkdir(parents=True, exist_ok=True)
    pages = given.pages or sorted(os.path.relpath(page, given.folder) for page in glob.glob(f"{given.folder}/**/*.html", recursive=True))
    browser = Browser(program)
    failed = 0
    try:
        for kind, fault in [] if given.no_faults else FAULTS:
            found = complaints(browser, given.folder, pages[0], fault)
            if not any(kind in one for one in found):
                print(f"a planted fault is not seen ({kind}): {fault}")
                failed += 1
        for page in pages:
            found = list(dict.fromkeys(complaints(browser, given.folder, page, shots=given.shots)))
            failed += len(found)
            print(f"{page}: {len(found) or 'no'} defects", *found, sep="\n    ")
        dead = markdown_links(given.folder)
        failed += len(dead)
        print(*dead, sep="\n")
    finally:
        browser.close()
    print(f"{len(pages)} pages, {failed} defects")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
