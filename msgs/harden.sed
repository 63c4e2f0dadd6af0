# lcm-gen's decoders believe the lengths that a message claims: one packet from a stranger, or one damaged log, with a string of
# length -2147483648 or an array of 2147483647 entries ends the process. Both lcm-gen 1.3 and 1.5 write these lines:
s/if\((__[A-Za-z0-9_]+) > maxlen - pos\) return -1;/if(\1 < 1 || \1 > maxlen - pos) return -1;/
# Every entry takes a byte at least.
s/^( *)(this->.*\.resize\((this->[A-Za-z0-9_]+)\);)/\1if(\3 < 0 || \3 > maxlen - pos) return -1;\n\1\2/
