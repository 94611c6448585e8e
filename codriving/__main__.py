"""`python -m codriving` is the command line."""

from codriving.cli import main

if __name__ == "__main__":
    main()
