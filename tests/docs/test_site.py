"""The site is made without a warning, with files beside docs/ that pages name."""

import subprocess

import pytest

from tests.conftest import ROOT

MKDOCS = ROOT / ".venv-site" / "bin" / "mkdocs"


@pytest.mark.skipif(not MKDOCS.exists(), reason="no .venv-site: make site")
def test_the_site_is_made_and_leads_to_files_beside_docs(tmp_path):
    site = tmp_path / "site"
    words = [MKDOCS, "build", "--strict", "--quiet", "--site-dir", site]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert 'href="CONTRIBUTING.html"' in (site / "index.html").read_text("utf-8")
    contributing = (site / "CONTRIBUTING.html").read_text("utf-8")
    assert 'href="design.html#layers"' in contributing
    assert (site / "config.yaml").read_bytes() == (ROOT / "config.yaml").read_bytes()
    assert not (site / "linked_files.py").exists()
