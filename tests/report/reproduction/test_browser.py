"""The front page in a real browser, and that the check sees what is wrong."""

import pytest

from tests.browser.seen import SIZES, all_faults, look
from tests.conftest import table as rows
from tests.report.reproduction.made import make_measured, make_page


def test_nothing_is_cut_off_at_any_width_in_light_or_dark(browser, results):
    assert all_faults(browser, results / "report.html") == []


def test_every_table_and_figure_is_there(browser, results):
    about = look(browser, results / "report.html", SIZES[0]).about
    counted = {table["name"]: table["rows"] for table in about["tables"]}
    for name in ("cells", "claims", "off", "audit"):
        assert counted[name] == len(rows(results / "compare" / f"{name}.csv")), name
    for number in (1, 2, 3, 4):
        name = f"table-{number}"
        file = results / "compare" / "tables" / f"{name}.csv"
        assert counted[name] == len(rows(file))
    drawn = {file.stem for file in (results / "figures").glob("*.svg")}
    assert {image["name"] for image in about["images"]} == drawn
    assert all(image["caption"] for image in about["images"])


def test_the_page_of_a_measured_dataset(browser, tmp_path):
    page = make_page(tmp_path, make_measured(tmp_path), dataset="bench")
    assert all_faults(browser, page) == []


FIRST = "[...document.querySelectorAll('#cells tbody tr')].map((r) => r.cells[5])"


def test_a_header_sorts_by_number_and_by_keyboard(browser, results):
    browser.open(results / "report.html", *SIZES[0])
    browser.evaluate("document.querySelector('details').open = true")
    button = "document.querySelectorAll('#cells th button')[5]"
    browser.evaluate(f"{button}.focus()")
    for order, sign in (("ascending", 1), ("descending", -1)):
        for kind in ("keyDown", "keyUp"):
            about = {"key": "Enter", "code": "Enter", "windowsVirtualKeyCode": 13}
            browser.call("Input.dispatchKeyEvent", type=kind, text="\r", **about)
        assert browser.evaluate(f"{button}.parentElement.ariaSort") == order
        shown = browser.evaluate(f"{FIRST}.map((c) => c.dataset.sort)")
        numbers = [sign * float(text) for text in shown if text]
        assert numbers == sorted(numbers)
        assert len(numbers) > 20
        # What was not run has no number, and stands last in either order.
        assert shown[len(numbers) :] == [""] * (len(shown) - len(numbers))


def test_a_filter_leaves_the_rows_that_fit_and_counts_them(browser, results):
    browser.open(results / "report.html", *SIZES[0])
    browser.evaluate(
        "(() => { const form = document.querySelector('#claims form');"
        "form.querySelector('select').value = 'not testable';"
        "form.dispatchEvent(new Event('input')); })()"
    )
    visible = browser.evaluate(
        "[...document.querySelectorAll('#claims tbody tr')].filter((r) =>"
        "r.getClientRects().length).map((r) => r.cells[0].textContent)"
    )
    claims = rows(results / "compare" / "claims.csv")
    wanted = sum(row["verdict"] == "not testable" for row in claims)
    assert visible == ["not testable"] * wanted
    told = browser.evaluate("document.querySelector('#claims output').textContent")
    assert told == f"{wanted} of {len(claims)} rows"


def test_the_switch_turns_the_colours(browser, results):
    browser.open(results / "report.html", *SIZES[0])
    colour = "getComputedStyle(document.body).backgroundColor"
    light = browser.evaluate(colour)
    browser.evaluate("document.getElementById('theme').click()")
    assert browser.evaluate(colour) != light
    browser.evaluate("document.getElementById('theme').click()")
    assert browser.evaluate(colour) == light


SENTENCE = '<p class="sentence"'
IMAGE = "data:image/svg+xml;base64,"


@pytest.mark.parametrize(
    ("old", "new", "fault"),
    [
        (SENTENCE, f'{SENTENCE} style="margin-top:-9rem"', "the headline is at"),
        (SENTENCE, f'{SENTENCE} style="margin-top:999px"', "the headline is at"),
        (SENTENCE, f'{SENTENCE} style="display:none"', "the headline is at"),
        ("<main", '<main style="width:2500px"', "wide in"),
        ("<h2", '<h2 style="margin-left:-5rem"', "outside of the window: h2"),
        ("<h2", '<h2 style="overflow:hidden;width:2rem"', "cut off in its box: h2"),
        (f"{IMAGE}PD94", f"{IMAGE}x", "missing picture"),
        ('alt="', 'alt="" title="', "no alternative text"),
        ("</main>", "</main><script>nothing.there</script>", "the console says"),
        ("</main>", "<script>console.error(1)</script></main>", "the console says"),
        ("</main>", '<img src="a.png" alt="a"></main>', "the console says"),
    ],
)
def test_the_check_sees_what_is_wrong(browser, copied, old, new, fault):
    page = copied / "report.html"
    text = page.read_text(encoding="utf-8")
    assert old in text
    page.write_text(text.replace(old, new), encoding="utf-8")
    found = list(look(browser, page, SIZES[0]).faults())
    assert any(fault in each for each in found), found


def test_the_check_sees_a_page_without_dark_colours(browser, copied):
    page = copied / "report.html"
    text = page.read_text(encoding="utf-8")
    page.write_text(text.replace("light dark;", "light;"), encoding="utf-8")
    assert any("dark: the ink is" in each for each in all_faults(browser, page))
