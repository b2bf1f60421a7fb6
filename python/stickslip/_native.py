"""The native module that suits the processor, in the place of this one.

On x86-64 there are two: one that runs everywhere, and a faster one for processors that add a product
in one instruction. Their last digits differ. `STICKSLIP_PORTABLE=1` asks for the first; 0 and nothing
do not.
"""

import importlib
import os
import sys

from stickslip._portable import _native as _chosen

if _chosen.processor_has_fused_products() and os.environ.get("STICKSLIP_PORTABLE", "") in ("", "0"):
    try:
        _chosen = importlib.import_module("stickslip._x86_64_v3._native")
    except ImportError:
        pass  # This wheel has one module only.

sys.modules[__name__] = _chosen
