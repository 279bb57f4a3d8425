#!/usr/bin/env bash
# tagged_repository.sh SOURCE REPOSITORY TAG: a git repository of the project's files as they lie there,
# committed or not, with a tag on it. 77: there is no git, or the source is no repository.
set -euo pipefail
source=$1 repository=$2 tag=$3
git -C "$source" rev-parse --git-dir &>/dev/null || exit 77

rm -rf "$repository"
git init -q "$repository"
# Files that were deleted and not committed are still listed.
(cd "$source" && git ls-files -z --cached --others --exclude-standard |
  while IFS= read -r -d '' file; do if [[ -e $file ]]; then printf '%s\0' "$file"; fi; done |
  xargs -0 cp --parents --no-dereference --target-directory "$repository")
git -C "$repository" add --all
git -C "$repository" -c user.name=nobody -c user.email=nobody@invalid -c commit.gpgsign=false \
  commit -q -m "As it is"
git -C "$repository" tag "$tag"
