# For scripts that people type: --help, or -h, shows the words at the script's head, and nothing is done.
case ${1:-} in -h | --help)
  sed -n '2,/^[^#]/{s/^# \{0,1\}//p}' "$0"
  exit 0
  ;;
esac
