/* A Bladed-style controller that does what its input file says: a word, and a time in s.

   Every call it demands a pitch of record 27, 28 and 30 in turn, a torque that is the sum of all
   generator speeds it was told (its memory), and counts its calls in the file "calls". */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static double memory = 0.0;
static char word[64] = "";
static double when = 0.0;

static void read_input(const char *name)
{
    FILE *file = fopen(name, "r");
    if (file == NULL) return;
    if (fscanf(file, "%63s %lf", word, &when) < 1) strcpy(word, "");
    fclose(file);
}

static void note_call(int status)
{
    FILE *file = fopen("calls", "a");
    fprintf(file, "%d\n", status);
    fclose(file);
}

static void misbehave(float *swap, int *failure, char *message)
{
    volatile int *nowhere = NULL;
    if (!strcmp(word, "crash")) *nowhere = 1;
    if (!strcmp(word, "hang")) for (;;) sleep(1);
    if (!strcmp(word, "exit")) { printf("parameter 7 is missing\n"); exit(3); }
    if (!strcmp(word, "nan")) swap[46] = NAN;
    if (!strcmp(word, "warn")) { *failure = 1; strcpy(message, "the wind is odd"); }
    if (!strcmp(word, "fail")) { *failure = -1; strcpy(message, "the wind is impossible"); }
    if (!strcmp(word, "brake")) { swap[35] = 16.0f; swap[106] = 100.0f; }
    if (!strcmp(word, "full")) swap[35] = 1.0f;
    if (!strcmp(word, "off")) swap[34] = 0.0f;
    if (!strcmp(word, "random")) swap[46] += (float)getpid();
    if (!strcmp(word, "chatter")) printf("time %g\n", swap[1]);
    if (!strcmp(word, "slow")) usleep(300000);
}

void DISCON(float *swap, int *failure, char *input, char *output, char *message)
{
    int status = (int)swap[0];
    if (status == 0) {
        read_input(input);
        if ((size_t)swap[49] != strlen(input) + 1 || (size_t)swap[50] != strlen(output) + 1) {
            *failure = -1;
            strcpy(message, "lengths of the names are wrong");
        }
        if (swap[65] != 1001.0f || swap[128] != 3300.0f) {
            *failure = -1;
            strcpy(message, "the platform's place or the array's size is wrong");
        }
    }
    note_call(status);
    memory += swap[19];
    swap[41] = swap[3] + 0.01f;
    swap[42] = swap[32] + 0.02f;
    swap[43] = swap[33] + 0.03f;
    swap[44] = swap[10];
    swap[46] = (float)memory;
    swap[47] = -swap[23];
    memset(output, 'x', (size_t)swap[63] - 1);
    if (status >= 0 && swap[1] >= when) misbehave(swap, failure, message);
}

void OTHER(float *swap, int *failure, char *input, char *output, char *message) { DISCON(swap, failure, input, output, message); }
