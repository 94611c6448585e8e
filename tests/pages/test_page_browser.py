"""The page in a real browser, Debian's Chromium without a window; passed over where there is none."""

import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

sync_api = pytest.importorskip("playwright.sync_api", reason="needs playwright: make test-browser")

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)

pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium")

CELL = "intersection-codriving-full"


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with sync_api.sync_playwright() as play:
        started = play.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield started
        started.close()


@pytest.fixture(params=[(1280, 800, "light"), (390, 844, "dark")], ids=["desktop", "phone"])
def tab(browser: Any, page: Path, request: pytest.FixtureRequest) -> Iterator[Any]:
    """An empty tab; at the end nothing may have been asked of the network, nor said on the console."""
    width, height, scheme = request.param
    context = browser.new_context(viewport={"width": width, "height": height}, color_scheme=scheme)
    opened = context.new_page()
    said, asked = [], []
    opened.on("console", lambda message: said.append(message.text))
    opened.on("pageerror", lambda error: said.append(str(error)))
    opened.on("request", lambda one: asked.append(one.url))
    opened.address = page.as_uri()
    yield opened
    assert said == []
    assert {url.partition("#")[0] for url in asked} == {page.as_uri()}
    context.close()


def open_at(tab: Any, link: str) -> None:
    tab.goto(f"{tab.address}{link}")
    if link:
        tab.wait_for_selector("#decision:not(:empty)")


def test_a_link_opens_an_episode_at_its_time_and_the_words_of_the_decision(tab: Any) -> None:
    open_at(tab, f"#ep=talking/{CELL}/20001&t=4&cav=CAV3")
    assert tab.text_content("#name") == "talking, seed 20001"
    assert tab.text_content("#time") == "4.0 s"
    assert re.fullmatch(r"CAV3 at 4\.0 s: (FASTER|SLOWER|IDLE|HOLD)", tab.text_content("#decision"))
    heads = tab.locator("#sections summary").all_text_contents()
    assert {"Actions", "Passing order", "What it knew"} <= set(heads)
    # No wider than the window.
    assert tab.evaluate("document.documentElement.scrollWidth <= innerWidth")


def test_scrubbing_keys_and_the_other_cav(tab: Any) -> None:
    open_at(tab, f"#ep=plain/{CELL}/20000")
    tab.locator("#scrub").fill("5")
    assert tab.text_content("#time") == "5.0 s"
    assert "&t=5&" in tab.url
    tab.keyboard.press("ArrowLeft")
    assert tab.text_content("#time") == "4.5 s"
    tab.keyboard.press("Shift+ArrowRight")
    assert tab.text_content("#time") == "4.6 s"
    assert tab.text_content("#decision").startswith("CAV1 at 4.5 s: ")
    tab.keyboard.press("c")
    assert tab.text_content("#decision").startswith("CAV2 at 4.5 s: ")
    tab.locator("#cavs button", has_text="CAV4").click()
    assert "&cav=CAV4" in tab.url
    tab.keyboard.press("End")
    assert tab.text_content("#ending").startswith("Timeout after 8.0 s")
    tab.keyboard.press("n")
    sync_api.expect(tab).to_have_title("plain, seed 20001")
    tab.keyboard.press("Escape")
    tab.wait_for_selector("#overview:visible")


def test_it_plays_and_pauses(tab: Any) -> None:
    open_at(tab, f"#ep=plain/{CELL}/20000&t=1")
    before = tab.evaluate("document.getElementById('road').toDataURL()")
    tab.select_option("#speed", "4")
    tab.click("#play")
    sync_api.expect(tab.locator("#time")).to_have_text(re.compile(r"[2-7]\.\d s"))
    tab.keyboard.press("Space")
    paused = tab.text_content("#time")
    assert tab.text_content("#play") == "Play"
    assert 2 <= float(paused.split()[0]) < 8
    assert tab.evaluate("document.getElementById('road').toDataURL()") != before
    tab.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    assert tab.text_content("#time") == paused


def test_the_list_filters_and_sorts(tab: Any) -> None:
    open_at(tab, "")
    seeds = tab.locator("#list tbody tr:visible td:first-child")
    assert tab.text_content("#f-count") == "4 of 4"
    tab.fill("#f-text", "talking 20001")
    assert seeds.all_text_contents() == ["20001"]
    assert tab.text_content("#f-count") == "1 of 4"
    tab.fill("#f-text", "")
    tab.select_option("#f-row", "plain")
    assert seeds.all_text_contents() == ["20000", "20001"]
    tab.locator("#list th button", has_text="seed").click()
    tab.locator("#list th button", has_text="seed").click()
    assert seeds.all_text_contents() == ["20001", "20000"]
    assert tab.locator("#list th").first.get_attribute("aria-sort") == "descending"
    tab.select_option("#f-ending", "timeout")
    tab.fill("#f-pet", "0")
    assert seeds.count() == 0
    tab.fill("#f-pet", "")
    seeds.first.locator("a").click()
    sync_api.expect(tab).to_have_title("plain, seed 20001")


def test_where_two_runs_part_both_are_drawn(tab: Any) -> None:
    open_at(tab, "")
    tab.locator(".parting a").first.click()
    tab.wait_for_selector("#other:not(:empty)")
    assert tab.text_content("#other").startswith("talking: ")
    assert "&with=talking/" in tab.url
    alone = tab.evaluate("document.getElementById('road').toDataURL()")
    tab.keyboard.press("End")
    assert tab.evaluate("document.getElementById('road').toDataURL()") != alone
    tab.select_option("#twin", "")
    assert not tab.is_visible("#other")
    assert "&with=" not in tab.url


def test_light_and_dark_by_the_switch(tab: Any) -> None:
    open_at(tab, "")
    colour = "getComputedStyle(document.body).backgroundColor"
    begun = tab.evaluate(colour)
    seen = {begun}
    for theme in ("light", "dark"):
        tab.click("#theme")
        assert tab.text_content("#theme") == f"Theme: {theme}"
        seen.add(tab.evaluate(colour))
    assert len(seen) == 2
    tab.click("#theme")
    assert tab.evaluate(colour) == begun


def test_an_episode_that_is_not_there_opens_the_list(tab: Any) -> None:
    tab.goto(f"{tab.address}#ep=plain/nowhere/1&t=3")
    assert tab.is_visible("#overview")
