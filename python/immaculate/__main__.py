"""`python -m immaculate`: the command line."""

from immaculate._program import main

main()
