#!/usr/bin/env bash
# Builds paper/main.pdf from main.tex and generated/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

packages="latexmk lmodern texlive-latex-recommended texlive-pictures texlive-science"
missing() {
  echo "$1; on Debian or Ubuntu:" >&2
  echo "  sudo apt-get install $packages" >&2
  exit 2
}

for tool in latexmk pdflatex bibtex; do
  command -v "$tool" >/dev/null || missing "$tool is not installed"
done
for file in lmodern.sty natbib.sty rotating.sty booktabs.sty microtype.sty pgfplots.sty pgfplotstable.sty; do
  kpsewhich "$file" >/dev/null || missing "$file is not installed"
done
for file in $(grep -oh 'generated/[a-z0-9.-]*' main.tex style.tex sections/*.tex | sort -u); do
  if [ ! -f "$file" ] && [ ! -f "$file.tex" ]; then
    echo "$file is missing; make it from the committed results, in the project's root:" >&2
    echo "  cargo run --release -- experiment publish" >&2
    exit 2
  fi
done

latexmk -pdf -interaction=nonstopmode -halt-on-error -silent main.tex
echo "paper/main.pdf"
