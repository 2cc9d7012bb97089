"""`python -m evolution` is `wordarm`."""

import sys

from evolution.cli import main

sys.exit(main())
