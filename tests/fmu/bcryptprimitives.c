/* Stands in for a Windows library that wine 8 lacks and that Rust's standard library takes its random numbers from. Built into a folder
 * of its own, for the test under wine only. */
__declspec(dllexport) int ProcessPrng(unsigned char *data, unsigned long long length)
{
    while (length--) *data++ = (unsigned char)(length * 167 + 13);
    return 1;
}
