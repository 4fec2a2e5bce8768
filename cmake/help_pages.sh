#!/bin/sh
# Makes the manual pages, the command reference and the completion for bash of what --help says, so that they never say
# anything else.
#
#   cmake/help_pages.sh PROGRAM VERSION DIR
#
# DIR, made if need be, receives commands.md, pcl_fft_ground.bash and for each command a manual page, compressed.
set -eu

program=$1 version=$2 folder=$3
mkdir -p "$folder"

# commands: a line "words of the command|what it does" for each, the program itself first.
commands() {
  "$program" --help | awk '
    NR == 3 { sub(/\.$/, ""); print "|" tolower(substr($0, 1, 1)) substr($0, 2) }
    /^Commands:/ { listed = 1; next }
    listed && !/^  / { exit }
    listed {
      words = $1 == "simulate" && $2 == "survey" ? "simulate survey" : $1
      sub(/^.*( -o DIR| -o FILE|CLOUD\.\.\.) +/, "")
      print words "|" $0
    }'
}

# pages FORMAT WORDS SUMMARY: the help of a command as a manual page, a chapter of the reference or a case of completion.
pages() {
  # shellcheck disable=SC2086  # words of a command
  "$program" $2 --help | awk -v format="$1" -v words="$2" -v summary="$3" -v version="$version" '
    function man(text) {
      gsub(/\\/, "\\e", text)
      gsub(/-/, "\\-", text)
      if (text ~ /^[.\047]/) text = "\\\\\\&" text
      return text
    }
    function markdown(text,    parts, k, count) {  # options as code, where they are not already
      count = split(text, parts, "`")
      text = ""
      for (k = 1; k <= count; ++k) {
        gsub(/\|/, "\\|", parts[k])
        if (k % 2) { gsub(/</, "\\&lt;", parts[k]); gsub(/--[a-z][a-z-]*/, "`&`", parts[k]) }
        text = text (k > 1 ? "`" : "") parts[k]
      }
      return text
    }
    # A heading stands alone, ends in a colon and is followed by options or examples.
    function is_heading(n) { return line[n] ~ /^[A-Z].*:$/ && line[n + 1] ~ /^  / }
    function is_option(n) { return line[n] ~ /^  -/ && in_group }
    function heading(text) {
      sub(/:$/, "", text)
      if (format == "man") print ".SS " man(text)
      if (format == "markdown") print "\n**" text "**\n"
    }
    function option(spec, meaning) {
      gsub(/^ +| +$/, "", spec)
      if (spec ~ /\[/) { gsub(/ \[ /, ", ", spec); sub(/ \]/, "", spec) }
      if (match(spec, / \(=.*\)$/)) {
        meaning = meaning " (" substr(spec, RSTART + 3)
        spec = substr(spec, 1, RSTART - 1)
      }
      if (format == "man") print ".TP\n.B " man(spec) "\n" man(meaning)
      if (format == "markdown") {
        if (!in_table) print "| option | meaning |\n|---|---|"
        gsub(/\|/, "\\|", spec)
        print "| `" spec "` | " markdown(meaning) " |"
        in_table = 1
      }
      if (format == "bash" && match(spec, /--[a-z-]+/)) options = options " " substr(spec, RSTART, RLENGTH)
    }
    function block(first) {  # indented lines, as they are
      if (format == "man") print ".nf"
      if (format == "markdown") print "\n```"
      for (n = first; n <= NR && line[n] ~ /^  /; ++n) {
        if (format == "man") print man(line[n])
        if (format == "markdown") print substr(line[n], 3)
      }
      if (format == "man") print ".fi"
      if (format == "markdown") print "```"
      return n - 1
    }
    { line[NR] = $0; if ($0 ~ /^            +[^ ]/ && !column) column = match($0, /[^ ]/) }
    END {
      name = "pcl_fft_ground" (words == "" ? "" : "-" words)
      gsub(/ /, "-", name)
      if (format == "man") {
        print ".TH \"" toupper(man(name)) "\" 1 \"\" \"pcl_fft_ground " version "\" \"User Commands\""
        print ".SH NAME\n" man(name) " \\- " man(summary) "\n.SH SYNOPSIS\n.nf"
      }
      if (format == "markdown") print "\n## " (words == "" ? "The program" : words) "\n\n```"
      for (n = 1; line[n] != ""; ++n) {
        if (format == "man") print man(substr(line[n], 8))
        if (format == "markdown") print substr(line[n], 8)
      }
      if (format == "man") print ".fi\n.SH DESCRIPTION"
      if (format == "markdown") print "```"
      for (++n; n <= NR; ++n) {
        if (line[n] == "") { in_group = 0; in_table = 0; if (format == "man") print ".PP"; if (format == "markdown") print "" }
        else if (is_heading(n)) { heading(line[n]); in_group = line[n + 1] ~ /^  -/ }
        else if (is_option(n)) {
          spec = substr(line[n], 1, column - 1); meaning = substr(line[n], column)
          if (length(line[n]) >= column && substr(line[n], column - 1, 1) != " ") { spec = line[n]; meaning = "" }
          while (line[n + 1] ~ /^            /) { sub(/ +$/, "", meaning); text = line[++n]; sub(/^ +/, "", text); meaning = meaning " " text }
          option(spec, meaning)
        }
        else if (line[n] ~ /^  /) n = block(n)
        else { if (format == "man") print man(line[n]); if (format == "markdown") print markdown(line[n]) }
      }
      if (format == "man") {
        print ".SH SEE ALSO"
        print words == "" ? "pcl_fft_ground\\-segment(1), pcl_fft_ground\\-evaluate(1), pcl_fft_ground\\-align(1)" : "pcl_fft_ground(1)"
      }
      if (format == "bash") print "    \"" words "\") options=\"" substr(options, 2) "\" ;;"
    }'
}

list=$(commands)
each_command() { # FORMAT
  echo "$list" | while IFS='|' read -r words summary; do pages "$1" "$words" "$summary"; done
}

echo "$list" | while IFS='|' read -r words summary; do
  name=$(echo "pcl_fft_ground $words" | sed 's/ *$//; s/ /-/g')
  pages man "$words" "$summary" | gzip -9n >"$folder/$name.1.gz"
done

{
  echo "# Command reference"
  echo
  echo "What \`pcl_fft_ground\` and its commands say with \`--help\`."
  each_command markdown
} >"$folder/commands.md"

{
  cat <<'TEXT'
# Completion of pcl_fft_ground for bash, made from --help.
_pcl_fft_ground() {
  local options="" word=${COMP_WORDS[COMP_CWORD]} command=""
  [ "$COMP_CWORD" -gt 1 ] && command=${COMP_WORDS[1]}
  [ "$COMP_CWORD" -gt 2 ] && [ "$command ${COMP_WORDS[2]}" = "simulate survey" ] && command="simulate survey"
  case "$command" in
TEXT
  each_command bash | sed '1d'
  cat <<TEXT
    "") options="$(echo "$list" | cut -d'|' -f1 | cut -d' ' -f1 | sort -u | tr '\n' ' ' | sed 's/^ *//')--help --version" ;;
  esac
  case "\$command \$word" in
    " "* | *" -"*) mapfile -t COMPREPLY < <(compgen -W "\$options" -- "\$word") ;;
    "simulate "*) [ "\$COMP_CWORD" -ne 2 ] || mapfile -t COMPREPLY < <(compgen -W "wreck pipes reef survey" -- "\$word") ;;
  esac
}
complete -o default -F _pcl_fft_ground pcl_fft_ground
TEXT
} >"$folder/pcl_fft_ground.bash"
