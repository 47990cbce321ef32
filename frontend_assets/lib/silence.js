/** Whether what a panel waits for is overdue, looked at again and again. */

import { useEffect, useRef, useSignal } from "vendor/preact.js";
import { overdue_s } from "./overdue.js";

const KEPT = 10;
const LOOK_MS = 500;

/** @returns {{came: () => void, silent_s: number}} `came` is to be called for each message; whole seconds */
export function useSilence() {
  const times_s = useRef(/** @type {number[]} */ ([]));
  const silent_s = useSignal(0);
  useEffect(() => {
    const timer = setInterval(() => {
      silent_s.value = Math.floor(overdue_s(times_s.current, performance.now() / 1000));
    }, LOOK_MS);
    return () => clearInterval(timer);
  }, []);
  const came = () => {
    times_s.current = [...times_s.current.slice(1 - KEPT), performance.now() / 1000];
    silent_s.value = 0;
  };
  return { came, silent_s: silent_s.value };
}
